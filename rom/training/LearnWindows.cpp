#include "rom/training/LearnWindows.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/base/Collectives.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/sampling/Sampling.hpp"
#include "rom/training/LearnClusters.hpp"
#include "rom/training/PodFacts.hpp"
#include "rom/training/UnknownRecord.hpp"

namespace kiln {
namespace {

/// Below this, A = [PΦ_r]⁺ amplifies what Φ_r misses more than a hundredfold.
constexpr double small_sigma = 1e-2;

/// PΦ_r on every rank: the rows of the sampled particles, each with its components.
MatrixView sampled_rows(const Map& rows, const MatrixView& modes, const std::vector<GlobalIndex>& ids, int components) {
  MatrixView result("kiln::rom::P Phi_r", ids.size() * components, modes.extent(1));
  const auto owned = local_size(rows);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const LocalIndex row = rows.getLocalElement(ids[i]);
    if (row < 0 || row >= owned) continue;
    for (int c = 0; c < components; ++c) {
      for (std::size_t k = 0; k < modes.extent(1); ++k) {
        result(i * components + c, k) = modes(row * components + c, k);
      }
    }
  }
  sum_over_ranks(*rows.getComm(), result.data(), result.size());
  return result;
}

}  // namespace

LearnWindows::LearnWindows(const Settings& settings, const FullOrderRuns& full_order, PetrovGalerkin& lspg)
    : settings_(settings),
      full_order_(full_order),
      lspg_(lspg),
      communicator_(full_order.model()->rows()->getComm()),
      residuals_(lspg.row_size()) {
  const Teuchos::ParameterList& snapshots = settings.block.sublist("snapshots");
  if (snapshots.isParameter("hold")) residuals_.limit(snapshots.get<int>("hold"), communicator_);
}

std::vector<LearnWindows::Marcher> LearnWindows::marchers() const {
  std::vector<Marcher> marchers;
  for (std::size_t point = 0; point < full_order_.learnt(); ++point) {
    full_order_.go_to(point);
    marchers.push_back({VectorView("kiln::rom::unknown", local_size(*lspg_.coordinates())),
                        Registry<TimeScheme>::create(settings_.input.sublist("time").sublist("scheme"),
                                                     TimeScheme::Context{lspg_, settings_.span.step})});
    lspg_.initial(marchers.back().x);
    marchers.back().scheme->start(marchers.back().x, 0.0);
  }
  return marchers;
}

LearntStates LearnWindows::march(std::vector<Marcher>& marchers, std::size_t window, int first_step, int last_step,
                                 const std::string& label) {
  std::vector<int> steps;
  if (clusters()) steps = clustering_steps(settings_.block.sublist("clustering"), first_step, last_step);
  LearntStates states{full_order_.parameters(), {}, {}};
  for (std::size_t point = 0; point < marchers.size(); ++point) {
    Marcher& marcher = marchers[point];
    ProgressObserver progress(
        marchers.size() == 1 ? label : fmt::format("{}, point {}/{}", label, point + 1, marchers.size()), first_step,
        *communicator_);
    UnknownRecord record(steps);
    std::vector<StepListener*> listeners{&record};
    if (!settings_.quiet) listeners.push_back(&progress);
    if (clusters()) {
      states.coordinates.emplace_back("kiln::rom::unknown", marcher.x.extent(0));
      Kokkos::deep_copy(states.coordinates.back(), marcher.x);
    }
    full_order_.go_to(point);
    lspg_.projection(window).forget_jacobian();
    const LoopTotals part =
        run_time_loop(lspg_, *marcher.scheme, marcher.x, {settings_.span.step, first_step, last_step}, listeners);
    states.coordinates.insert(states.coordinates.end(), record.unknowns().begin(), record.unknowns().end());
    states.at.resize(states.coordinates.size(), point);
    totals_ += part;
  }
  full_order_.go_home();
  return states;
}

WindowReduction LearnWindows::learn_window(double end, Pod basis) {
  const std::shared_ptr<Model>& model = full_order_.model();
  const int components = static_cast<int>(model->fields().size());
  // With fewer residual modes than coordinates, Gauss–Newton's equations have more than one solution.
  PodSettings settings = settings_.residual_basis;
  settings.at_least = basis.truncation.rank;
  Pod residual_basis = pod(residuals_, settings, *communicator_);
  residuals_.restart();
  const Teuchos::ParameterList& sampling = settings_.block.sublist("sampling");
  const std::vector<GlobalIndex> sampled =
      Registry<Sampling>::create(sampling, NoContext{})->sample(*model->rows(), residual_basis.modes, components);
  GappyOperator gappy =
      gappy_operator(sampled_rows(*model->rows(), residual_basis.modes, sampled, components), sampling.name());
  residual_basis.modes = {};
  return {end, std::move(basis), std::move(residual_basis), gappy, sampled, sampled_or_masked(model, sampled)};
}

void LearnWindows::add_clusters(std::vector<WindowReduction>& windows, const LearntStates& states,
                                nlohmann::json& facts) const {
  const VectorView reference = Kokkos::subview(full_order_.reference(), std::make_pair(0, lspg_.row_size()));
  ClusteredMesh mesh =
      learn_clusters(settings_.block.sublist("clustering"), *full_order_.model(), reference, windows, states);
  facts["clusters"].push_back({{"clusters", mesh.clusters.clusters()},
                               {"pairs", mesh.clusters.row_clusters.size()},
                               {"unclustered_pairs", mesh.unclustered_pairs}});
  windows.back().clustered = std::move(mesh);
}

void LearnWindows::check(const WindowReduction& window) {
  const int coordinates = window.basis.truncation.rank, residual_modes = window.residual_basis.truncation.rank;
  if (residual_modes < coordinates) {
    warnings_.push_back(fmt::format(
        "the residuals of the window that ends at {:g} s hold only {} independent modes, which do not determine the "
        "coordinates of its {} basis vectors: GNAT has no single solution there; take fewer basis vectors, longer "
        "windows or a larger snapshots.hold",
        window.end, residual_modes, coordinates));
  }
  if (window.gappy_operator.smallest_singular_value >= small_sigma) return;
  warnings_.push_back(fmt::format(
      "the smallest singular value of PΦ_r is {:.2e} in the window that ends at {:g} s: the hyper-reduced "
      "residual may amplify what the residual basis misses by {:.0f}; take more samples or fewer residual "
      "modes",
      window.gappy_operator.smallest_singular_value, window.end, 1.0 / window.gappy_operator.smallest_singular_value));
}

std::vector<WindowReduction> LearnWindows::learn(const std::vector<int>& ends, std::vector<Pod> bases,
                                                 nlohmann::json& facts) {
  std::vector<Marcher> marchers = this->marchers();
  lspg_.observe_residuals([this](ConstVectorView residual) { residuals_.append(residual); });
  facts["residual_basis"] = facts["sample_meshes"] = nlohmann::json::array();
  if (clusters()) facts["clusters"] = nlohmann::json::array();
  totals_ = {};
  std::size_t taken = 0;
  double discarded = 0.0;
  std::vector<WindowReduction> windows;
  int first_step = 0;
  for (std::size_t w = 0; w < ends.size(); ++w) {
    const std::string label = ends.size() == 1 ? "LSPG" : fmt::format("LSPG, window {}/{}", w + 1, ends.size());
    const LearntStates states = march(marchers, w, first_step, ends[w], label);
    taken += residuals_.appended();
    discarded = std::max(discarded, residuals_.discarded_energy());
    windows.push_back(learn_window(ends[w] * settings_.span.step, std::move(bases[w])));
    if (clusters()) add_clusters(windows, states, facts);
    const WindowReduction& window = windows.back();
    facts["residual_basis"].push_back(facts_of(window.residual_basis));
    facts["sample_meshes"].push_back({{"end_s", window.end},
                                      {"sampled", window.sampled.size()},
                                      {"sigma_min", window.gappy_operator.smallest_singular_value},
                                      {"gappy_condition", window.gappy_operator.condition}});
    check(window);
    first_step = ends[w];
  }
  lspg_.observe_residuals({});
  facts["lspg"] = {{"steps", totals_.steps},
                   {"residuals", totals_.residuals},
                   {"capped_steps", totals_.capped_steps},
                   {"residual_snapshots", taken},
                   {"residual_energy_discarded", discarded}};
  return windows;
}

}  // namespace kiln
