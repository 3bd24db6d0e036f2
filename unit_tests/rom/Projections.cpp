#include "Projections.hpp"

#include <Tpetra_Map.hpp>
#include <cmath>
#include <limits>

#include "framework/driver/TimeLoop.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/sampling/GappyOperator.hpp"

namespace kiln::test {
namespace {

std::size_t local_count(const Map& map) { return map.getMyGlobalIndices().extent(0); }

VectorView leading(const VectorView& values, std::size_t count) {
  return Kokkos::subview(values, std::make_pair(std::size_t(0), count));
}

}  // namespace

MatrixView cosines(const Map& map, int components, int all_entries, int modes) {
  MatrixView result("cosines", local_count(map) * components, modes);
  for (std::size_t i = 0; i < local_count(map); ++i) {
    for (int c = 0; c < components; ++c) {
      const auto entry = map.getGlobalElement(static_cast<LocalIndex>(i)) * components + c;
      for (int k = 0; k < modes; ++k) {
        result(i * components + c, k) = std::sqrt((k == 0 ? 1.0 : 2.0) / all_entries) *
                                        std::cos(M_PI * (static_cast<double>(entry) + 0.5) * k / all_entries);
      }
    }
  }
  return result;
}

std::shared_ptr<Model> model_of(const Case& values, const Teuchos::RCP<const Communicator>& communicator) {
  return Registry<Model>::create(input_of(values).sublist("model"), Model::Context{communicator});
}

NewtonSettings newton_of(const Case& values) {
  return NewtonSettings(input_of(values).sublist("time").sublist("newton"));
}

std::unique_ptr<PetrovGalerkin> projection(std::shared_ptr<Model> model, const Case& values, int modes,
                                           std::unique_ptr<TestBasis> test) {
  const int components = values.components, all = values.count * components;
  VectorView reference("reference", local_count(*model->sources()) * components);
  model->initial_state(reference);
  const std::size_t rows = local_count(*model->rows());
  PetrovGalerkin::Parts parts;
  parts.trial = std::make_unique<AffineBasis>(reference, cosines(*model->sources(), components, all, modes));
  parts.test = std::move(test);
  parts.held = {model->rows(), Kokkos::subview(model->positions(), std::make_pair(std::size_t(0), rows), Kokkos::ALL),
                std::make_unique<AffineBasis>(leading(reference, rows * components),
                                              cosines(*model->rows(), components, all, modes))};
  parts.model = std::move(model);
  return std::make_unique<PetrovGalerkin>(std::move(parts), newton_of(values));
}

std::unique_ptr<PetrovGalerkin> gnat_projection(std::shared_ptr<Model> model, const Case& values, int modes,
                                                int residual_modes) {
  const int components = values.components, all = values.count * components;
  // PΦ_r of all ranks, in ascending order of ids, then this rank's columns of A.
  const Map& rows = *model->rows();
  std::vector<double> marks(values.count, 0.0);
  for (std::size_t i = 0; i < local_count(rows); ++i) marks[rows.getGlobalElement(static_cast<LocalIndex>(i))] = 1.0;
  dense::sum_over_ranks(*rows.getComm(), marks.data(), marks.size());
  std::vector<GlobalIndex> sampled;
  for (int id = 0; id < values.count; ++id) {
    if (marks[id] > 0.0) sampled.push_back(id);
  }
  const Map everywhere(sampled.size(), Teuchos::arrayViewFromVector(sampled), 0, self());
  const GappyOperator gappy = gappy_operator(cosines(everywhere, components, all, residual_modes), "sampling");
  MatrixView mine("A", residual_modes, local_count(rows) * components);
  for (std::size_t i = 0; i < local_count(rows); ++i) {
    const LocalIndex place = everywhere.getLocalElement(rows.getGlobalElement(static_cast<LocalIndex>(i)));
    for (int c = 0; c < components; ++c) {
      for (int k = 0; k < residual_modes; ++k) mine(k, i * components + c) = gappy.matrix(k, place * components + c);
    }
  }
  return projection(std::move(model), values, modes, std::make_unique<GnatTestBasis>(mine));
}

std::vector<double> gathered_state(const Method& method, ConstVectorView x) {
  const Map& map = *method.particles();
  const int components = static_cast<int>(method.fields().size());
  VectorView u("state", local_count(map) * components);
  method.state(x, u);
  std::vector<double> all((map.getMaxAllGlobalIndex() + 1) * components, 0.0);
  for (std::size_t i = 0; i < local_count(map); ++i) {
    for (int c = 0; c < components; ++c) {
      all[map.getGlobalElement(static_cast<LocalIndex>(i)) * components + c] = u(i * components + c);
    }
  }
  dense::sum_over_ranks(*map.getComm(), all.data(), all.size());
  return all;
}

std::vector<double> march(Method& method, const Case& values) {
  VectorView x("x", method.coordinates()->getMyGlobalIndices().extent(0));
  method.initial(x);
  const auto scheme = Registry<TimeScheme>::create(input_of(values).sublist("time").sublist("scheme"),
                                                   TimeScheme::Context{method, values.step});
  scheme->start(x, 0.0);
  run_time_loop(method, *scheme, x, {values.step, 0, values.steps}, {});
  return gathered_state(method, x);
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;
  }
  return largest;
}

}  // namespace kiln::test
