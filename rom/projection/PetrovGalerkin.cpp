#include "rom/projection/PetrovGalerkin.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {
namespace {

/// Step times are sums of round-off; a step that ends at a window's end belongs to that window.
constexpr double round_off = 1e-9;

}  // namespace

PetrovGalerkin::PetrovGalerkin(Parts parts, const NewtonSettings& settings, Projection::Factors factors)
    : particles_(std::move(parts.particles)),
      positions_(parts.positions),
      settings_(settings),
      reduction_(std::move(parts.reduction)),
      trained_(std::move(parts.trained)),
      questions_(std::move(parts.questions)) {
  for (Window& window : parts.windows) {
    windows_.push_back({window.end, std::make_unique<Projection>(std::move(window.projection), settings, factors),
                        std::move(window.held)});
  }
  const TrialSpace& last = windows_.back().projection->trial();
  coordinates_ = Teuchos::rcp(new Map(last.first() + last.size(), 0, particles_->getComm(), Tpetra::LocallyReplicated));
  parameters_ = projection().model().parameters();
  const Model* first = &projection().model();
  for (const OwnedWindow& window : windows_) {
    if (&window.projection->model() != first) parameters_.mirror(window.projection->model().parameters());
  }
}

std::size_t PetrovGalerkin::window_at(double time) const {
  const auto serves = [time](const OwnedWindow& window) { return time <= window.end * (1.0 + round_off); };
  const auto found = std::find_if(windows_.begin(), windows_.end() - 1, serves);
  return static_cast<std::size_t>(found - windows_.begin());
}

void PetrovGalerkin::forget() {
  for (const OwnedWindow& window : windows_) window.projection->forget_jacobian();
  current_ = 0;
}

bool PetrovGalerkin::begin_step(double time) {
  const std::size_t window = window_at(time);
  if (window == current_) return false;
  current_ = window;
  projection().forget_jacobian();
  return true;
}

void PetrovGalerkin::evaluate(ConstVectorView x, double time, VectorView u, VectorView f) {
  projection().evaluate(x, time, u, f);
}

SolveReport PetrovGalerkin::solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) {
  return projection().solve(residual, x, u, f);
}

NearestParticle PetrovGalerkin::nearest(const std::array<double, 3>& point) const {
  const NearestParticle found = nearest_particle(*particles_, positions_, point);
  return !questions_ || questions_->tells(point, found.distance) ? found : NearestParticle{};
}

std::vector<std::string> PetrovGalerkin::warnings() const {
  const std::string outside = outside_of(trained_, parameters_);
  return outside.empty() ? std::vector<std::string>{} : std::vector<std::string>{outside};
}

Method::Reader PetrovGalerkin::reader(const std::vector<LocalIndex>& places) const {
  const int components = static_cast<int>(fields().size());
  std::vector<std::shared_ptr<const TrialSpace>> spaces;
  for (const OwnedWindow& window : windows_) spaces.push_back(window.held->restricted(places, components));
  return [this, spaces = std::move(spaces)](ConstVectorView x, VectorView u) { spaces[current_]->state(x, u); };
}

void PetrovGalerkin::save(hdf5::Group& group) const {
  group.attribute("reduction", reduction_);
  group.attribute("window", static_cast<long long>(current_));
  projection().save(group);
}

void PetrovGalerkin::restore(const hdf5::Group& group) {
  if (const std::string reduction = group.text("reduction"); reduction != reduction_) {
    throw FileError(group.file(), group.path() + ", attribute reduction",
                    fmt::format("the run began with reduction {}", reduction),
                    fmt::format("{}, the one that is there now: start anew, without --restart", reduction_));
  }
  const long long window = group.integer("window");
  if (window < 0 || window >= static_cast<long long>(windows_.size())) {
    throw FileError(group.file(), group.path() + ", attribute window", std::to_string(window),
                    "a time window of the reduction: 0 to " + std::to_string(windows_.size() - 1));
  }
  current_ = static_cast<std::size_t>(window);
  projection().restore(group, local_size(*coordinates_));
}

void PetrovGalerkin::report(nlohmann::json& section) const {
  int largest = 0;
  for (const OwnedWindow& window : windows_) largest = std::max(largest, window.projection->trial().size());
  if (!reduction_.empty()) section["reduction_seal"] = reduction_;
  section["time_windows"] = windows_.size();
  section["basis_rank"] = largest;
  section["coordinates"] = coordinates_->getGlobalNumElements();
  section["rows"] = static_cast<long long>(projection().model().rows()->getGlobalNumElements());
  section["jacobian"] = to_text(settings_.jacobian);
  section["refresh"] = settings_.refresh;
}

void PetrovGalerkin::report_work(nlohmann::json& section) const {
  long long linearisations = 0;
  double condition = 1.0;
  for (const OwnedWindow& window : windows_) {
    linearisations += window.projection->linearisations();
    condition = std::min(condition, window.projection->reciprocal_condition());
  }
  section["linearisations"] = linearisations;
  section["reduced_jacobian_reciprocal_condition"] = condition;
}

void PetrovGalerkin::observe_residuals(const std::function<void(ConstVectorView)>& observer) {
  for (const OwnedWindow& window : windows_) window.projection->observe_residuals(observer);
}

}  // namespace kiln
