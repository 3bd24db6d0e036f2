#include "rom/projection/FullSize.hpp"

#include <Tpetra_Map.hpp>

#include "framework/registry/Registry.hpp"
#include "rom/basis/AffineBasis.hpp"

namespace kiln {
namespace {

constexpr const char* kept = "kept";
constexpr const char* every_iteration = "every iteration";

}  // namespace

Specification reduced_specification() {
  Specification s;
  s.file("file", "the reduction file `kiln train` wrote; left out: reduction.h5 in output.directory").optional();
  s.choice("factors",
           "when the test basis and the factors of the reduced Jacobian are formed: with each new Jacobian, or "
           "in every iteration as Algorithm 1 is printed",
           {kept, every_iteration})
      .defaults_to(kept);
  return s;
}

Projection::Factors factors_of(const Teuchos::ParameterList& method) {
  return method.get<std::string>("factors") == kept ? Projection::Factors::kept : Projection::Factors::every_iteration;
}

PetrovGalerkin::Parts full_size_parts(const std::shared_ptr<Model>& model, const std::vector<TimeWindow>& windows,
                                      ConstVectorView reference, ConstMatrixView modes,
                                      const std::function<std::unique_ptr<TestBasis>()>& test_basis) {
  const std::size_t particles = local_size(*model->rows());
  const std::size_t rows = particles * model->fields().size();
  PetrovGalerkin::Parts parts;
  parts.particles = model->rows();
  parts.positions = Kokkos::subview(model->positions(), std::make_pair(std::size_t(0), particles), Kokkos::ALL);
  std::shared_ptr<const TrialSpace> space_on_sources, space_on_rows;
  for (const TimeWindow& window : windows) {
    const ConstMatrixView on_sources = dense::leading_columns(modes, window.first + window.size);
    const ConstVectorView reference_of_rows = Kokkos::subview(reference, std::make_pair(std::size_t(0), rows));
    space_on_sources = std::make_shared<AffineBasis>(reference, on_sources, window.first, space_on_sources);
    space_on_rows = std::make_shared<AffineBasis>(reference_of_rows, dense::row_block(on_sources, 0, rows),
                                                  window.first, space_on_rows);
    parts.windows.push_back({window.end, {model, space_on_sources, test_basis()}, space_on_rows});
  }
  return parts;
}

PetrovGalerkin::Parts full_size_parts(const Method::Context& context,
                                      const std::function<std::unique_ptr<TestBasis>()>& test_basis) {
  const ReductionFile reduction(context.input, context.communicator);
  reduction.require_end(context.input);
  const std::shared_ptr<Model> model =
      Registry<Model>::create(context.input.sublist("model"), Model::Context{context.communicator});
  reduction.require_size(*model->rows(), model->fields().size());
  const BasisRows rows = reduction.basis(*model->sources());
  PetrovGalerkin::Parts parts = full_size_parts(model, reduction.windows(), rows.reference, rows.modes, test_basis);
  parts.reduction = reduction.fingerprint();
  parts.trained = reduction.trained_ranges();
  return parts;
}

}  // namespace kiln
