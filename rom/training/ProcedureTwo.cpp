#include "rom/training/ProcedureTwo.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/base/StopRequest.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Seal.hpp"
#include "framework/model/Halo.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/clustering/SourceClustering.hpp"
#include "rom/projection/FullSize.hpp"
#include "rom/sampling/Sampling.hpp"
#include "rom/training/LearnClusters.hpp"
#include "rom/training/LearnWindows.hpp"
#include "rom/training/PodFacts.hpp"

namespace kiln {
namespace {

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

}  // namespace

Specification ProcedureTwo::specification() {
  Specification s;
  s.section("windows", "time windows, each with basis and sample mesh of its own; left out: one",
            WindowSettings::specification())
      .optional();
  s.section("basis", "trial basis of a window, from snapshots of the state", PodSettings::specification());
  s.section("residual_basis",
            "basis of a window's residual, from an LSPG run without hyper-reduction; by energy it has at least as many "
            "vectors as the trial basis",
            PodSettings::specification());
  s.component<Sampling>("sampling", "which particles the hyper-reduced run evaluates").defaults_to("greedy");
  s.component<SourceClustering>("clustering",
                                "how each sampled particle's sources become few, for ptrom; left out: not at all")
      .optional();
  s.section("snapshots", "of the full-order state", snapshot_specification());
  s.sections("queries",
             "further positions whose state online runs can tell; probes of the output are always among them",
             query_specification())
      .optional();
  FullOrderRuns::specify(s);
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    const bool by_error = list.isSublist("windows") && list.sublist("windows").isParameter("error");
    const Teuchos::ParameterList& basis = list.sublist("basis");
    const Teuchos::ParameterList& residual_basis = list.sublist("residual_basis");
    if (by_error && !basis.isParameter("rank")) {
      problems.push_back({"windows.error", "goes with a basis of fixed rank, and basis has none", "basis.rank", {}});
    }
    if (by_error && list.isSublist("train_on")) {
      problems.push_back({"windows.error", "goes with one point to learn from", "windows.count or windows.steps", {}});
    }
    if (basis.isParameter("rank") && residual_basis.isParameter("rank") &&
        residual_basis.get<int>("rank") < basis.get<int>("rank")) {
      problems.push_back({"residual_basis.rank",
                          fmt::format("{} residual modes do not determine the coordinates of {} basis vectors",
                                      residual_basis.get<int>("rank"), basis.get<int>("rank")),
                          fmt::format("at least basis.rank, {}", basis.get<int>("rank")),
                          {}});
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
      every_(std::min(block.sublist("snapshots").get<int>("every"), span_.last_step)) {
  // In one window a rank too high is a mistake; of several, some may hold less.
  basis_settings_.rank_is_cap = residual_settings_.rank_is_cap = windows_.count != 1;
  if (windows_.count && *windows_.count > snapshots()) {
    throw InputError(block.name() + ".windows.count",
                     fmt::format("{} windows are more than the {} snapshots of the run", *windows_.count, snapshots()),
                     fmt::format("at most {}{}", snapshots(), every_ > 1 ? ", or a smaller snapshots.every" : ""));
  }
}

int ProcedureTwo::snapshots() const { return (span_.last_step + every_ - 1) / every_; }

void ProcedureTwo::stage(const std::string& name, RunReport& report, const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const auto number = report.section("training")["stages"].size() + 1;
  StopRequest::end_if_asked(*communicator_, fmt::format("before stage {} of the training, {}", number, name));
  if (!quiet_ && communicator_->getRank() == 0) fmt::print(stderr, "training, stage {}: {}\n", number, name);
  work();
  communicator_->barrier();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report.section("training")["stages"].push_back({{"name", name}, {"wall_s", seconds.count()}});
}

void ProcedureTwo::warn(const std::string& warning, RunReport& report) const {
  report.section("training")["warnings"].push_back(warning);
  if (communicator_->getRank() == 0) fmt::print(stderr, "warning: {}\n", warning);
}

std::vector<int> ProcedureTwo::window_ends(double error) const {
  const int snapshots = this->snapshots();
  std::vector<int> ends;
  if (windows_.error) {
    ends = windows_within(*costs_, *basis_settings_.rank, error);
    // Round-off must not make ranks disagree.
    broadcast(*communicator_, 0, ends);
  } else if (windows_.count) {
    const int count = *windows_.count;
    for (int w = 1; w <= count; ++w) ends.push_back(static_cast<int>(static_cast<long long>(snapshots) * w / count));
  } else {
    const int length = std::max(1, (std::min(*windows_.steps, span_.last_step) + every_ - 1) / every_);
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
  const Snapshots& snapshots = full_order_->snapshots();
  // The TSQR overwrites what it factors, and a further attempt would factor it again.
  if (ends.size() == 1 && !windows_.error) {
    bases.push_back(pod(snapshots, basis_settings_, *communicator_));
    facts.push_back(facts_of(bases.back()));
    facts.back()["energy_discarded"] = snapshots.discarded_energy();
    return bases;
  }
  const MatrixView states = snapshots.matrix();
  const std::size_t a_run = snapshots.count() / full_order_->learnt();
  std::size_t begin = 0;
  Snapshots increments(snapshots.rows());
  VectorView increment("kiln::rom::increment", snapshots.rows());
  for (const int step : ends) {
    const std::size_t end = (step + every_ - 1) / every_;
    increments.restart();
    increments.reserve((end - begin) * full_order_->learnt());
    for (std::size_t run = 0; run < full_order_->learnt(); ++run) {
      const std::size_t first = run * a_run;
      for (std::size_t n = first + begin; n < first + end; ++n) {
        for (std::size_t i = 0; i < increment.extent(0); ++i) {
          increment(i) = begin == 0 ? states(i, n) : states(i, n) - states(i, first + begin - 1);
        }
        increments.append(increment);
      }
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
  const std::shared_ptr<Model>& model = full_order_->model();
  const Halo halo(*model);
  const MatrixView modes("kiln::rom::modes at the sources", halo.source_size(), first);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto columns = std::make_pair(windows[w].first, windows[w].first + windows[w].size);
    const MultiVector from(halo.rows(), bases[w].modes);
    MultiVector to(halo.sources(), MatrixView(Kokkos::subview(modes, Kokkos::ALL, columns)));
    halo.bring(from, to);
  }
  return std::make_unique<PetrovGalerkin>(full_size_parts(model, windows, full_order_->reference(), modes,
                                                          [] { return std::make_unique<LspgTestBasis>(); }),
                                          newton_);
}

ProcedureTwo::Trials ProcedureTwo::attempt(const std::string& path, double error, RunReport& report) {
  std::vector<int> ends;
  std::vector<Pod> bases;
  stage("POD of the state", report, [&] {
    ends = window_ends(error);
    bases = window_bases(ends, report);
  });
  if (!windows_.error) full_order_->snapshots().clear();
  std::unique_ptr<PetrovGalerkin> lspg;
  std::vector<WindowReduction> windows;
  stage("LSPG run, POD of its residuals, sampling", report, [&] {
    lspg = lspg_method(ends, bases);
    LearnWindows learner({input_, block_, span_, residual_settings_, quiet_}, *full_order_, *lspg);
    windows = learner.learn(ends, std::move(bases), report.section("training"));
    for (const std::string& warning : learner.warnings()) warn(warning, report);
  });
  stage("reduction file", report, [&] {
    const VectorView rows = Kokkos::subview(full_order_->reference(), std::make_pair(0, lspg->row_size()));
    write_reduction(path, {input_, *full_order_->model(), rows, std::move(windows), full_order_->questions(),
                           full_order_->extremes(), full_order_->parameters(), full_order_->data_hashes()});
  });
  Trials trials;
  stage("trial run", report, [&] {
    trials.gnat = try_all("gnat", "trial", path, *lspg, report);
    if (clusters()) trials.ptrom = try_all("ptrom", "trial_clustered", path, *lspg, report);
  });
  report.section("training")["time_windows"] = ends.size();
  return trials;
}

void ProcedureTwo::warn_of(const TrialErrors& errors, const std::string& run, RunReport& report) const {
  if (errors.diverged) {
    warn(fmt::format("the {} of the reduction diverged: take more samples, fewer residual modes or shorter windows",
                     run),
         report);
  } else if (errors.capped_steps > 0) {
    warn(fmt::format("{} steps of the {} reached the cap of iterations", errors.capped_steps, run), report);
  }
}

TrialErrors ProcedureTwo::try_all(const std::string& method, const std::string& section, const std::string& path,
                                  PetrovGalerkin& lspg, RunReport& report) const {
  nlohmann::json points = nlohmann::json::array();
  TrialErrors worst;
  for (std::size_t point = 0; point < full_order_->points(); ++point) {
    const TrialErrors errors = trial_run(method, input_, path, span_, full_order_->trial(point), lspg, communicator_);
    worst = worst.worse(errors);
    points.push_back(errors.facts());
    points.back()["at"] = full_order_->values(point);
    points.back()["learnt"] = point < full_order_->learnt();
  }
  nlohmann::json& facts = report.section("training")[section];
  facts = worst.facts();
  if (full_order_->points() > 1) facts["points"] = points;
  return worst;
}

void ProcedureTwo::check_ranks(std::size_t snapshots, std::optional<int> hold) const {
  const std::size_t most =
      std::min(snapshots, static_cast<std::size_t>(hold.value_or(std::numeric_limits<int>::max())));
  if (!basis_settings_.rank || basis_settings_.rank_is_cap || static_cast<std::size_t>(*basis_settings_.rank) <= most) {
    return;
  }
  throw InputError(
      block_.name() + ".basis.rank",
      fmt::format("{} basis vectors are more than the {} snapshots that are held", *basis_settings_.rank, most),
      fmt::format("at most {}, {}", most,
                  most < snapshots ? "or a larger snapshots.hold" : "or a smaller snapshots.every"));
}

std::unique_ptr<FullOrderRuns> ProcedureTwo::full_order_runs() const {
  const Teuchos::ParameterList& snapshots = block_.sublist("snapshots");
  FullOrderRuns::Settings settings{span_, every_, std::nullopt, quiet_};
  if (windows_.count == 1 && snapshots.isParameter("hold")) settings.hold = snapshots.get<int>("hold");
  auto runs = std::make_unique<FullOrderRuns>(input_, block_, settings, communicator_);
  check_ranks(runs->learnt() * static_cast<std::size_t>(this->snapshots()), settings.hold);
  const Model& model = *runs->model();
  Registry<Sampling>::create(block_.sublist("sampling"), NoContext{})
      ->check(static_cast<GlobalIndex>(model.rows()->getGlobalNumElements()), static_cast<int>(model.fields().size()),
              residual_settings_.rank_is_cap ? 0 : residual_settings_.rank.value_or(basis_settings_.rank.value_or(0)));
  if (clusters()) check_clustering(block_.sublist("clustering"), model);
  return runs;
}

void ProcedureTwo::run_full_order(RunReport& report) {
  if (full_order_ == nullptr) check();
  full_order_->run();
  LoopTotals totals;
  for (const LoopTotals& run : full_order_->totals()) totals += run;
  for (const std::string& warning : totals.warnings()) warn("full order: " + warning, report);
  nlohmann::json& facts = report.section("training");
  facts["full_order"] = {{"runs", full_order_->points()},
                         {"steps", totals.steps},
                         {"residuals", totals.residuals},
                         {"capped_steps", totals.capped_steps}};
  facts["state_snapshots"] = full_order_->snapshots().appended();
  facts["queried"] = full_order_->questions().particles().size();
}

void ProcedureTwo::train(const std::filesystem::path& file, RunReport& report) {
  nlohmann::json& facts = report.section("training");
  facts["stages"] = nlohmann::json::array();
  facts["warnings"] = nlohmann::json::array();
  stage("full-order run", report, [&] { run_full_order(report); });

  AtomicPath path(file, communicator_);
  double aim = windows_.error.value_or(0.0);
  if (windows_.error) costs_ = std::make_unique<WindowCosts>(full_order_->snapshots(), *communicator_);
  Trials trials = attempt(path.temporary(), aim, report);
  const TrialErrors& errors = trials.gnat;
  if (windows_.error) {
    const double wanted = *windows_.error;
    const auto reached = [this](const TrialErrors& trial) {
      return full_order_->trial(0).queries.empty() ? trial.field : trial.worst_query;
    };
    for (int k = 1; k < most_attempts && (errors.diverged || reached(errors) > wanted); ++k) {
      aim *= errors.diverged ? 0.3 : std::clamp(0.7 * wanted / reached(errors), 0.1, 0.7);
      trials = attempt(path.temporary(), aim, report);
    }
    if (!errors.diverged && reached(errors) > wanted) {
      warn(fmt::format("windows with an error of {:.3g} % were asked for; the last of {} attempts has {:.3g} %: take "
                       "more samples, residual modes or basis modes",
                       100 * wanted, most_attempts, 100 * reached(errors)),
           report);
    }
  }
  warn_of(errors, "trial run", report);
  if (trials.ptrom) warn_of(*trials.ptrom, "trial run on clustered sources", report);
  {
    hdf5::File written = hdf5::File::modify(path.temporary(), communicator_);
    written.attribute("trial", json_text(facts["trial"]));
    if (trials.ptrom) written.attribute("trial_clustered", json_text(facts["trial_clustered"]));
    written.flush();
  }
  hdf5::seal(path.temporary(), *communicator_);
  path.commit();
}

KILN_REGISTER(Trainer, ProcedureTwo, "procedure ii",
              "full-order run, POD, LSPG run, POD of its residuals, sampling (GNAT's procedure II)");

}  // namespace kiln
