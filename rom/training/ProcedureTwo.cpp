#include "rom/training/ProcedureTwo.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <chrono>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/method/FullOrder.hpp"
#include "framework/model/Halo.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/files/Reduction.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/sampling/GappyOperator.hpp"
#include "rom/sampling/Sampling.hpp"
#include "rom/training/Queries.hpp"
#include "rom/training/SnapshotObserver.hpp"

namespace kiln {
namespace {

/// Below this, A = [PΦ_r]⁺ amplifies what Φ_r misses more than a hundredfold.
constexpr double small_sigma = 1e-2;

Specification snapshot_specification() {
  Specification s;
  s.integer("every", "steps between two snapshots of the state").at_least(1).defaults_to(1);
  return s;
}

Specification query_specification() {
  Specification s;
  s.reals("position", "where; the nearest particle is taken").unit("m").length(3);
  return s;
}

/// The modes on a model's sources, from those on its rows.
MatrixView on_sources(const Model& model, const MatrixView& modes) {
  const Halo halo(model);
  const MatrixView sources("kiln::rom::modes at the sources", halo.source_size(), modes.extent(1));
  const MultiVector from(halo.rows(), modes);
  MultiVector to(halo.sources(), sources);
  halo.bring(from, to);
  return sources;
}

VectorView initial_state(const Model& model) {
  VectorView state("kiln::rom::initial state", model.sources()->getMyGlobalIndices().extent(0) * model.fields().size());
  model.initial_state(state);
  return state;
}

VectorView leading(const VectorView& values, std::size_t count) {
  return Kokkos::subview(values, std::make_pair(std::size_t(0), count));
}

nlohmann::json facts_of(const Pod& pod) {
  return {{"rank", pod.truncation.rank},
          {"energy", pod.truncation.energy},
          {"independent", pod.truncation.independent},
          {"snapshots", pod.singular_values.size()},
          {"largest_singular_value", pod.singular_values.front()},
          {"last_singular_value_kept", pod.singular_values[pod.truncation.rank - 1]},
          {"orthogonality", pod.orthogonality},
          {"reorthogonalised", pod.reorthogonalised}};
}

/// PΦ_r on every rank: the rows of the sampled particles, each with its components.
MatrixView sampled_rows(const Map& rows, const MatrixView& modes, const std::vector<GlobalIndex>& ids, int components) {
  MatrixView result("kiln::rom::P Phi_r", ids.size() * components, modes.extent(1));
  const auto owned = static_cast<LocalIndex>(rows.getMyGlobalIndices().extent(0));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const LocalIndex row = rows.getLocalElement(ids[i]);
    if (row < 0 || row >= owned) continue;
    for (int c = 0; c < components; ++c) {
      for (std::size_t k = 0; k < modes.extent(1); ++k) {
        result(i * components + c, k) = modes(row * components + c, k);
      }
    }
  }
  dense::sum_over_ranks(*rows.getComm(), result.data(), result.size());
  return result;
}

}  // namespace

Specification ProcedureTwo::specification() {
  Specification s;
  s.section("basis", "trial basis, from snapshots of the state", PodSettings::specification());
  s.section("residual_basis", "basis of the residual, from an LSPG run without hyper-reduction",
            PodSettings::specification());
  s.component<Sampling>("sampling", "which particles the hyper-reduced run evaluates").defaults_to("greedy");
  s.section("snapshots", "of the full-order state", snapshot_specification());
  s.sections("queries",
             "further positions whose state online runs can tell; probes of the output are always among them",
             query_specification())
      .optional();
  return s;
}

ProcedureTwo::ProcedureTwo(const Teuchos::ParameterList& block, const Context& context)
    : input_(context.input),
      block_(block),
      communicator_(context.communicator),
      quiet_(context.quiet),
      span_(TimeSpan::of(context.input)),
      newton_(context.input.sublist("time").sublist("newton")),
      basis_settings_(block.sublist("basis")),
      residual_settings_(block.sublist("residual_basis")) {}

void ProcedureTwo::stage(const std::string& name, RunReport& report, const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const auto number = report.section("training")["stages"].size() + 1;
  if (!quiet_ && communicator_->getRank() == 0) fmt::print(stderr, "training {}/5: {}\n", number, name);
  work();
  communicator_->barrier();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report.section("training")["stages"].push_back({{"name", name}, {"wall_s", seconds.count()}});
}

LoopTotals ProcedureTwo::march(Method& method, std::vector<Observer*> observers, const std::string& label) {
  VectorView x("kiln::rom::unknown", method.coordinates()->getMyGlobalIndices().extent(0));
  method.initial(x);
  const std::unique_ptr<TimeScheme> scheme =
      Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"), TimeScheme::Context{method, span_.step});
  scheme->start(x, 0.0);
  ProgressObserver progress(label, 0, *communicator_);
  if (!quiet_) observers.push_back(&progress);
  return run_time_loop(method, *scheme, x, span_, observers);
}

Snapshots ProcedureTwo::run_full_order(RunReport& report) {
  FullOrder method(block_, Method::Context{input_, communicator_});
  model_ = method.model();
  Snapshots snapshots(method.row_size());
  SnapshotObserver observer(method, snapshots, block_.sublist("snapshots").get<int>("every"));
  const LoopTotals totals = march(method, {&observer}, "full order");
  observer.finish(report);
  report.section("training")["full_order"] = {{"steps", totals.steps}, {"residuals", totals.residuals}};
  return snapshots;
}

Snapshots ProcedureTwo::run_lspg(const Pod& basis, RunReport& report) {
  const VectorView reference = initial_state(*model_);
  PetrovGalerkin method(
      full_size_parts(model_, std::make_unique<AffineBasis>(reference, on_sources(*model_, basis.modes)),
                      std::make_unique<AffineBasis>(leading(reference, basis.modes.extent(0)), basis.modes),
                      std::make_unique<LspgTestBasis>()),
      newton_);
  Snapshots residuals(method.row_size());
  method.observe_residuals([&residuals](ConstVectorView residual) { residuals.append(residual); });
  const LoopTotals totals = march(method, {}, "LSPG");
  report.section("training")["lspg"] = {{"steps", totals.steps},
                                        {"residuals", totals.residuals},
                                        {"capped_steps", totals.capped_steps},
                                        {"residual_snapshots", residuals.count()}};
  return residuals;
}

void ProcedureTwo::train(const std::filesystem::path& file, RunReport& report) {
  nlohmann::json& facts = report.section("training");
  facts["stages"] = nlohmann::json::array();
  facts["warnings"] = nlohmann::json::array();

  Snapshots snapshots(0), residuals(0);
  Pod basis, residual_basis;
  stage("full-order run", report, [&] { snapshots = run_full_order(report); });
  stage("POD of the state", report, [&] { basis = pod(snapshots, basis_settings_, *communicator_); });
  facts["basis"] = facts_of(basis);
  snapshots.clear();

  stage("LSPG run", report, [&] { residuals = run_lspg(basis, report); });
  const int components = static_cast<int>(model_->fields().size());
  std::vector<GlobalIndex> sampled;
  stage("POD of the residual and sampling", report, [&] {
    residual_basis = pod(residuals, residual_settings_, *communicator_);
    residuals.clear();
    sampled = Registry<Sampling>::create(block_.sublist("sampling"), NoContext{})
                  ->sample(*model_->rows(), residual_basis.modes, components);
  });
  facts["residual_basis"] = facts_of(residual_basis);

  stage("sample mesh and file", report, [&] {
    const GappyOperator gappy = gappy_operator(sampled_rows(*model_->rows(), residual_basis.modes, sampled, components),
                                               block_.sublist("sampling").name());
    facts["sampled"] = sampled.size();
    facts["sigma_min"] = gappy.smallest_singular_value;
    facts["gappy_condition"] = gappy.condition;
    if (gappy.smallest_singular_value < small_sigma) {
      const std::string warning = fmt::format(
          "the smallest singular value of PΦ_r is {:.2e}: the hyper-reduced residual may amplify what the residual "
          "basis misses by {:.0f}; take more samples or fewer residual modes",
          gappy.smallest_singular_value, 1.0 / gappy.smallest_singular_value);
      facts["warnings"].push_back(warning);
      if (communicator_->getRank() == 0) fmt::print(stderr, "warning: {}\n", warning);
    }
    const std::unique_ptr<Model> sample = sampled_or_masked(model_, sampled);
    const std::vector<GlobalIndex> queries = nearest_particles(*model_, queried_positions(input_));
    facts["queried"] = queries.size();
    write_reduction(file, {input_, *model_, leading(initial_state(*model_), basis.modes.extent(0)), basis,
                           residual_basis, gappy, *sample, sampled, queries});
  });
}

KILN_REGISTER(Trainer, ProcedureTwo, "procedure ii",
              "full-order run, POD, LSPG run, POD of its residuals, sampling (GNAT's procedure II)");

}  // namespace kiln
