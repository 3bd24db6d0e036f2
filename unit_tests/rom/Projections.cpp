#include "Projections.hpp"

#include <Tpetra_Map.hpp>
#include <cmath>
#include <limits>

#include "framework/base/Collectives.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/sampling/GappyOperator.hpp"

namespace kiln::test {
MatrixView cosines(const Map& map, int components, int all_entries, int modes) {
  MatrixView result("cosines", local_size(map) * components, modes);
  for (LocalIndex i = 0; i < local_size(map); ++i) {
    for (int c = 0; c < components; ++c) {
      const auto entry = map.getGlobalElement(i) * components + c;
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

PetrovGalerkin::Parts parts_of(const std::shared_ptr<Model>& model, const Case& values, const MatrixView& on_sources,
                               const std::vector<TimeWindow>& windows,
                               const std::function<std::unique_ptr<TestBasis>()>& test) {
  VectorView reference("reference", local_size(*model->sources()) * values.components);
  model->initial_state(reference);
  return full_size_parts(model, windows, reference, on_sources, test);
}

std::unique_ptr<PetrovGalerkin> projection(const std::shared_ptr<Model>& model, const Case& values, int modes,
                                           const std::function<std::unique_ptr<TestBasis>()>& test) {
  const MatrixView basis = cosines(*model->sources(), values.components, values.count * values.components, modes);
  return std::make_unique<PetrovGalerkin>(
      parts_of(model, values, basis, {{values.step * values.steps, 0, modes}}, test), newton_of(values));
}

std::unique_ptr<TestBasis> galerkin_test() { return std::make_unique<GalerkinTestBasis>(); }
std::unique_ptr<TestBasis> lspg_test() { return std::make_unique<LspgTestBasis>(); }

std::function<std::unique_ptr<TestBasis>()> gnat_test(const Model& model, const Case& values, int residual_modes) {
  const int components = values.components, all = values.count * components;
  // PΦ_r of all ranks, in ascending order of ids, then this rank's columns of A.
  const Map& rows = *model.rows();
  std::vector<double> marks(values.count, 0.0);
  for (LocalIndex i = 0; i < local_size(rows); ++i) marks[rows.getGlobalElement(i)] = 1.0;
  sum_over_ranks(*rows.getComm(), marks.data(), marks.size());
  std::vector<GlobalIndex> sampled;
  for (int id = 0; id < values.count; ++id) {
    if (marks[id] > 0.0) sampled.push_back(id);
  }
  const Map everywhere(sampled.size(), Teuchos::arrayViewFromVector(sampled), 0, self());
  const GappyOperator gappy = gappy_operator(cosines(everywhere, components, all, residual_modes), "sampling");
  MatrixView mine("A", residual_modes, local_size(rows) * components);
  for (LocalIndex i = 0; i < local_size(rows); ++i) {
    const LocalIndex place = everywhere.getLocalElement(rows.getGlobalElement(i));
    for (int c = 0; c < components; ++c) {
      for (int k = 0; k < residual_modes; ++k) mine(k, i * components + c) = gappy.matrix(k, place * components + c);
    }
  }
  return [mine] { return std::make_unique<GnatTestBasis>(mine); };
}

std::unique_ptr<PetrovGalerkin> gnat_projection(const std::shared_ptr<Model>& model, const Case& values, int modes,
                                                int residual_modes) {
  return projection(model, values, modes, gnat_test(*model, values, residual_modes));
}

std::vector<double> gathered_state(const Method& method, ConstVectorView x) {
  const Map& map = *method.particles();
  const int components = static_cast<int>(method.fields().size());
  VectorView u("state", local_size(map) * components);
  method.state(x, u);
  std::vector<double> all((map.getMaxAllGlobalIndex() + 1) * components, 0.0);
  for (LocalIndex i = 0; i < local_size(map); ++i) {
    for (int c = 0; c < components; ++c) {
      all[map.getGlobalElement(i) * components + c] = u(i * components + c);
    }
  }
  sum_over_ranks(*map.getComm(), all.data(), all.size());
  return all;
}

RunReport train(const Case& values, const Teuchos::RCP<const Communicator>& communicator) {
  const Teuchos::ParameterList input = input_of(values);
  RunReport report;
  Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, communicator, true})
      ->train(values.folder + "/reduction.h5", report);
  return report;
}

void check_training(const Case& values, const Teuchos::RCP<const Communicator>& communicator) {
  const Teuchos::ParameterList input = input_of(values);
  Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, communicator, true})->check();
}

std::unique_ptr<Method> method_of(Case values, const std::string& type,
                                  const Teuchos::RCP<const Communicator>& communicator) {
  values.method = type;
  const Teuchos::ParameterList input = input_of(values);
  return Registry<Method>::create(input.sublist("method"), Method::Context{input, communicator});
}

std::vector<double> march(Method& method, const Case& values, const std::vector<StepListener*>& listeners) {
  VectorView x("x", local_size(*method.coordinates()));
  method.initial(x);
  const auto scheme = Registry<TimeScheme>::create(input_of(values).sublist("time").sublist("scheme"),
                                                   TimeScheme::Context{method, values.step});
  scheme->start(x, 0.0);
  run_time_loop(method, *scheme, x, {values.step, 0, values.steps}, listeners);
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
