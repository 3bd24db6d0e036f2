#include "rom/projection/FullSize.hpp"

#include <Tpetra_Map.hpp>

#include "framework/registry/Registry.hpp"

namespace kiln {

Specification reduced_specification() {
  Specification s;
  s.file("file", "the reduction file `kiln train` wrote; left out: reduction.h5 in output.directory").optional();
  return s;
}

PetrovGalerkin::Parts full_size_parts(std::shared_ptr<Model> model, std::unique_ptr<TrialSpace> on_sources,
                                      std::unique_ptr<TrialSpace> on_rows, std::unique_ptr<TestBasis> test) {
  const Teuchos::RCP<const Map> rows = model->rows();
  const std::size_t count = rows->getMyGlobalIndices().extent(0);
  const ConstPositionView positions =
      Kokkos::subview(model->positions(), std::make_pair(std::size_t(0), count), Kokkos::ALL);
  return {std::move(model), std::move(on_sources), std::move(test), {rows, positions, std::move(on_rows)}};
}

PetrovGalerkin::Parts full_size_parts(const Method::Context& context, std::unique_ptr<TestBasis> test) {
  const ReductionFile reduction(context.input, context.communicator);
  std::shared_ptr<Model> model =
      Registry<Model>::create(context.input.sublist("model"), Model::Context{context.communicator});
  std::unique_ptr<TrialSpace> on_sources = reduction.basis(*model->sources());
  std::unique_ptr<TrialSpace> on_rows = reduction.basis(*model->rows());
  return full_size_parts(std::move(model), std::move(on_sources), std::move(on_rows), std::move(test));
}

}  // namespace kiln
