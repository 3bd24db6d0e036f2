#include "rom/training/ProcedureTwo.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/Error.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Seal.hpp"
#include "framework/method/FullOrder.hpp"
#include "framework/model/Halo.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/sampling/Sampling.hpp"
#include "rom/training/Queries.hpp"
#include "rom/training/SnapshotObserver.hpp"

namespace kiln {
namespace {

/// Below this, A = [PΦ_r]⁺ amplifies what Φ_r misses more than a hundredfold.
constexpr double small_sigma = 1e-2;

/// Moments at which the trial run's whole field is compared with the full-order one.
constexpr int trial_moments = 20;
/// How often windows are cut shorter for an error they have missed.
constexpr int most_attempts = 4;

Specification snapshot_specification() {
  Specification s;
  s.integer("every", "steps between two snapshots of the state").at_least(1).defaults_to(1);
  s.integer(
       "hold",
       "most snapshots held in memory, of the residual and, in one window, of the state; more of them are merged into "
       "their leading singular vectors")
      .at_least(2)
      .optional();
  return s;
}

Specification query_specification() {
  Specification s;
  s.reals("position", "where; the nearest particle is taken").unit("m").length(3);
  return s;
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
  s.section("windows", "time windows, each with basis and sample mesh of its own; left out: one",
            WindowSettings::specification())
      .optional();
  s.section("basis", "trial basis of a window, from snapshots of the state", PodSettings::specification());
  s.section("residual_basis", "basis of a window's residual, from an LSPG run without hyper-reduction",
            PodSettings::specification());
  s.component<Sampling>("sampling", "which particles the hyper-reduced run evaluates").defaults_to("greedy");
  s.section("snapshots", "of the full-order state", snapshot_specification());
  s.sections("queries",
             "further positions whose state online runs can tell; probes of the output are always among them",
             query_specification())
      .optional();
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    const bool by_error = list.isSublist("windows") && list.sublist("windows").isParameter("error");
    if (by_error && !list.sublist("basis").isParameter("rank")) {
      problems.push_back({"windows.error", "goes with a basis of fixed rank, and basis has none", "basis.rank", {}});
    }
  });
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
      residual_settings_(block.sublist("residual_basis")),
      windows_(WindowSettings::of(block.isSublist("windows") ? &block.sublist("windows") : nullptr)),
      every_(block.sublist("snapshots").get<int>("every")),
      snapshots_(0),
      trial_{{}, {}, {}, Snapshots(0)} {
  // In one window a rank too high is a mistake; of several, some may hold less.
  basis_settings_.rank_is_cap = residual_settings_.rank_is_cap = windows_.count != 1;
}

void ProcedureTwo::stage(const std::string& name, RunReport& report, const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const auto number = report.section("training")["stages"].size() + 1;
  if (!quiet_ && communicator_->getRank() == 0) fmt::print(stderr, "training, stage {}: {}\n", number, name);
  work();
  communicator_->barrier();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report.section("training")["stages"].push_back({{"name", name}, {"wall_s", seconds.count()}});
}

void ProcedureTwo::hold_at_most(Snapshots& snapshots) const {
  const Teuchos::ParameterList& settings = block_.sublist("snapshots");
  if (settings.isParameter("hold")) snapshots.limit(settings.get<int>("hold"), communicator_);
}

void ProcedureTwo::warn(const std::string& warning, RunReport& report) const {
  report.section("training")["warnings"].push_back(warning);
  if (communicator_->getRank() == 0) fmt::print(stderr, "warning: {}\n", warning);
}

void ProcedureTwo::run_full_order(RunReport& report) {
  FullOrder method(block_, Method::Context{input_, communicator_});
  model_ = method.model();
  reference_ = VectorView("kiln::rom::initial state", local_size(*model_->sources()) * model_->fields().size());
  model_->initial_state(reference_);
  snapshots_ = Snapshots(method.row_size());
  if (windows_.count == 1) hold_at_most(snapshots_);
  SnapshotObserver observer(method, snapshots_, every_);
  trial_.queries = nearest_particles(*model_, queried_positions(input_));
  QueryRecord record(method, trial_.queries);

  VectorView x("kiln::rom::unknown", method.row_size());
  method.initial(x);
  const std::unique_ptr<TimeScheme> scheme =
      Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"), TimeScheme::Context{method, span_.step});
  scheme->start(x, 0.0);
  ProgressObserver progress("full order", 0, *communicator_);
  const int moments = std::min(span_.last_step, trial_moments);
  for (int k = 1; k <= moments; ++k) {
    trial_.steps.push_back(static_cast<int>(static_cast<long long>(span_.last_step) * k / moments));
  }
  trial_.states = Snapshots(method.row_size());
  StateRecord states(method, trial_.steps, trial_.states);
  std::vector<Observer*> observers{&observer, &record, &states};
  if (!quiet_) observers.push_back(&progress);
  const LoopTotals totals = run_time_loop(method, *scheme, x, span_, observers);

  observer.finish(report);
  trial_.query_values = record.values();
  report.section("training")["full_order"] = {{"steps", totals.steps}, {"residuals", totals.residuals}};
}

std::vector<int> ProcedureTwo::window_ends(double error) const {
  const int snapshots = (span_.last_step + every_ - 1) / every_;
  std::vector<int> ends;
  if (windows_.error) {
    ends = windows_within(*costs_, *basis_settings_.rank, error);
    // Round-off must not make ranks disagree.
    int count = static_cast<int>(ends.size());
    Teuchos::broadcast(*communicator_, 0, &count);
    ends.resize(count);
    Teuchos::broadcast(*communicator_, 0, count, ends.data());
  } else if (windows_.count) {
    const int count = std::min(*windows_.count, snapshots);
    for (int w = 1; w <= count; ++w) ends.push_back(static_cast<int>(static_cast<long long>(snapshots) * w / count));
  } else {
    const int length = std::max(1, (*windows_.steps + every_ - 1) / every_);
    for (int end = length; end < snapshots; end += length) ends.push_back(end);
    ends.push_back(snapshots);
  }
  for (int& end : ends) end = std::min(end * every_, span_.last_step);
  return ends;
}

std::vector<Pod> ProcedureTwo::window_bases(const std::vector<int>& ends, RunReport& report) const {
  nlohmann::json& facts = report.section("training")["basis"];
  facts = nlohmann::json::array();
  std::vector<Pod> bases;
  std::size_t begin = 0;
  const MatrixView states = snapshots_.matrix();
  if (ends.size() == 1) {
    bases.push_back(pod(snapshots_, basis_settings_, *communicator_));
    facts.push_back(facts_of(bases.back()));
    facts.back()["energy_discarded"] = snapshots_.discarded_energy();
    return bases;
  }
  for (const int step : ends) {
    const std::size_t end = (step + every_ - 1) / every_;
    Snapshots increments(snapshots_.rows());
    VectorView increment("kiln::rom::increment", snapshots_.rows());
    for (std::size_t n = begin; n < end; ++n) {
      for (std::size_t i = 0; i < increment.extent(0); ++i) {
        increment(i) = begin == 0 ? states(i, n) : states(i, n) - states(i, begin - 1);
      }
      increments.append(increment);
    }
    bases.push_back(pod(increments, basis_settings_, *communicator_));
    facts.push_back(facts_of(bases.back()));
    begin = end;
  }
  return bases;
}

std::unique_ptr<PetrovGalerkin> ProcedureTwo::lspg_method(const std::vector<int>& ends,
                                                          const std::vector<Pod>& bases) const {
  std::vector<TimeWindow> windows;
  int first = 0;
  for (std::size_t w = 0; w < ends.size(); ++w) {
    const int size = bases[w].truncation.rank;
    windows.push_back({ends[w] * span_.step, first, size});
    first += size;
  }
  const Halo halo(*model_);
  const MatrixView modes("kiln::rom::modes at the sources", halo.source_size(), first);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto columns = std::make_pair(windows[w].first, windows[w].first + windows[w].size);
    const MultiVector from(halo.rows(), bases[w].modes);
    MultiVector to(halo.sources(), MatrixView(Kokkos::subview(modes, Kokkos::ALL, columns)));
    halo.bring(from, to);
  }
  return std::make_unique<PetrovGalerkin>(
      full_size_parts(model_, windows, reference_, modes, [] { return std::make_unique<LspgTestBasis>(); }), newton_);
}

WindowReduction ProcedureTwo::learn_window(double end, Pod basis, Snapshots& residuals) {
  const int components = static_cast<int>(model_->fields().size());
  Pod residual_basis = pod(residuals, residual_settings_, *communicator_);
  residuals.clear();
  const std::vector<GlobalIndex> sampled = Registry<Sampling>::create(block_.sublist("sampling"), NoContext{})
                                               ->sample(*model_->rows(), residual_basis.modes, components);
  GappyOperator gappy = gappy_operator(sampled_rows(*model_->rows(), residual_basis.modes, sampled, components),
                                       block_.sublist("sampling").name());
  residual_basis.modes = {};
  return {end, std::move(basis), std::move(residual_basis), gappy, sampled, sampled_or_masked(model_, sampled)};
}

std::vector<WindowReduction> ProcedureTwo::learn_windows(const std::vector<int>& ends, std::vector<Pod> bases,
                                                         PetrovGalerkin& lspg, RunReport& report) {
  VectorView x("kiln::rom::unknown", lspg.coordinates()->getMyGlobalIndices().extent(0));
  lspg.initial(x);
  const std::unique_ptr<TimeScheme> scheme =
      Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"), TimeScheme::Context{lspg, span_.step});
  scheme->start(x, 0.0);
  Snapshots residuals(lspg.row_size());
  hold_at_most(residuals);
  lspg.observe_residuals([&residuals](ConstVectorView residual) { residuals.append(residual); });

  nlohmann::json& facts = report.section("training");
  facts["residual_basis"] = facts["sample_meshes"] = nlohmann::json::array();
  LoopTotals totals;
  std::size_t taken = 0;
  double discarded = 0.0;
  std::vector<WindowReduction> windows;
  int first_step = 0;
  for (std::size_t w = 0; w < ends.size(); ++w) {
    const std::string label = ends.size() == 1 ? "LSPG" : fmt::format("LSPG, window {}/{}", w + 1, ends.size());
    ProgressObserver progress(label, first_step, *communicator_);
    std::vector<Observer*> observers;
    if (!quiet_) observers.push_back(&progress);
    const LoopTotals part = run_time_loop(lspg, *scheme, x, {span_.step, first_step, ends[w]}, observers);
    totals.steps += part.steps;
    totals.residuals += part.residuals;
    totals.capped_steps += part.capped_steps;
    taken += residuals.appended();
    discarded = std::max(discarded, residuals.discarded_energy());
    windows.push_back(learn_window(ends[w] * span_.step, std::move(bases[w]), residuals));
    const WindowReduction& window = windows.back();
    facts["residual_basis"].push_back(facts_of(window.residual_basis));
    facts["sample_meshes"].push_back({{"end_s", window.end},
                                      {"sampled", window.sampled.size()},
                                      {"sigma_min", window.gappy_operator.smallest_singular_value},
                                      {"gappy_condition", window.gappy_operator.condition}});
    if (window.gappy_operator.smallest_singular_value < small_sigma) {
      warn(fmt::format("the smallest singular value of PΦ_r is {:.2e} in the window that ends at {:g} s: the "
                       "hyper-reduced residual may amplify what the residual basis misses by {:.0f}; take more "
                       "samples or fewer residual modes",
                       window.gappy_operator.smallest_singular_value, window.end,
                       1.0 / window.gappy_operator.smallest_singular_value),
           report);
    }
    first_step = ends[w];
  }
  lspg.observe_residuals({});
  facts["lspg"] = {{"steps", totals.steps},
                   {"residuals", totals.residuals},
                   {"capped_steps", totals.capped_steps},
                   {"residual_snapshots", taken},
                   {"residual_energy_discarded", discarded}};
  return windows;
}

TrialErrors ProcedureTwo::attempt(const std::string& path, double error, RunReport& report) {
  std::vector<int> ends;
  std::vector<Pod> bases;
  stage("POD of the state", report, [&] {
    ends = window_ends(error);
    bases = window_bases(ends, report);
  });
  if (!windows_.error) snapshots_.clear();
  std::unique_ptr<PetrovGalerkin> lspg;
  std::vector<WindowReduction> windows;
  stage("LSPG run, POD of its residuals, sampling", report, [&] {
    lspg = lspg_method(ends, bases);
    windows = learn_windows(ends, std::move(bases), *lspg, report);
  });
  stage("reduction file", report, [&] {
    const VectorView rows = Kokkos::subview(reference_, std::make_pair(0, lspg->row_size()));
    write_reduction(path, {input_, *model_, rows, std::move(windows), trial_.queries});
  });
  TrialErrors errors;
  stage("trial run", report, [&] { errors = trial_run(input_, path, span_, trial_, *lspg, communicator_); });
  report.section("training")["time_windows"] = ends.size();
  report.section("training")["trial"] = errors.facts();
  return errors;
}

void ProcedureTwo::train(const std::filesystem::path& file, RunReport& report) {
  nlohmann::json& facts = report.section("training");
  facts["stages"] = nlohmann::json::array();
  facts["warnings"] = nlohmann::json::array();
  stage("full-order run", report, [&] { run_full_order(report); });
  facts["queried"] = trial_.queries.size();

  AtomicPath path(file, communicator_);
  double aim = windows_.error.value_or(0.0);
  if (windows_.error) costs_ = std::make_unique<WindowCosts>(snapshots_, *communicator_);
  TrialErrors errors = attempt(path.temporary(), aim, report);
  if (windows_.error) {
    const double wanted = *windows_.error;
    const auto reached = [this](const TrialErrors& trial) {
      return trial_.queries.empty() ? trial.field : trial.worst_query;
    };
    for (int k = 1; k < most_attempts && (errors.diverged || reached(errors) > wanted); ++k) {
      aim *= errors.diverged ? 0.3 : std::clamp(0.7 * wanted / reached(errors), 0.1, 0.7);
      errors = attempt(path.temporary(), aim, report);
    }
    if (!errors.diverged && reached(errors) > wanted) {
      warn(fmt::format("windows with an error of {:.3g} % were asked for; the last of {} attempts has {:.3g} %: take "
                       "more samples, residual modes or basis modes",
                       100 * wanted, most_attempts, 100 * reached(errors)),
           report);
    }
  }
  if (errors.diverged) {
    warn("the trial run of the reduction diverged: take more samples, fewer residual modes or shorter windows", report);
  } else if (errors.capped_steps > 0) {
    warn(fmt::format("{} steps of the trial run reached the cap of iterations", errors.capped_steps), report);
  }
  {
    hdf5::File written = hdf5::File::modify(path.temporary(), communicator_);
    written.attribute("trial", errors.facts().dump());
    written.flush();
  }
  hdf5::seal(path.temporary(), *communicator_);
  path.commit();
}

KILN_REGISTER(Trainer, ProcedureTwo, "procedure ii",
              "full-order run, POD, LSPG run, POD of its residuals, sampling (GNAT's procedure II)");

}  // namespace kiln
