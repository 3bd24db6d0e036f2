#include "rom/training/FullOrderRuns.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "framework/observers/ProgressObserver.hpp"
#include "framework/queries/QueryPoints.hpp"
#include "framework/registry/Registry.hpp"
#include "rom/files/ReductionIdentity.hpp"
#include "rom/training/ExtremeRecord.hpp"
#include "rom/training/Queries.hpp"
#include "rom/training/SnapshotRecord.hpp"

namespace kiln {
namespace {

/// Moments at which a trial run's whole field is compared with the full-order one.
constexpr int trial_moments = 20;

constexpr std::array<const char*, 2> keys = {"train_on", "try_on"};

/// The input's own values with those of one of `points` in their place.
std::vector<double> values_with(const ParameterPoints& own, const ParameterPoints& points, std::size_t point) {
  std::vector<double> values = own.values.front();
  for (std::size_t k = 0; k < points.names.size(); ++k) {
    const auto place = std::find(own.names.begin(), own.names.end(), points.names[k]) - own.names.begin();
    values[place] = points.values[point][k];
  }
  return values;
}

}  // namespace

void FullOrderRuns::specify(Specification& reduction) {
  reduction
      .section("train_on",
               "points of the model's live parameters to learn from, a full-order run each; left out: the input's own",
               points_specification())
      .optional();
  reduction
      .section("try_on",
               "further points, on which the reduction is only tried: a full-order run each, to state the error there",
               points_specification())
      .optional();
}

void FullOrderRuns::collect_points(const Teuchos::ParameterList& block) {
  const Parameters& parameters = model()->parameters();
  own_ = ParameterPoints::of(parameters);
  points_.names = own_.names;
  for (const char* key : keys) {
    if (block.isSublist(key)) {
      const ParameterPoints listed = points_of(block.sublist(key), parameters);
      for (std::size_t point = 0; point < listed.count(); ++point) {
        points_.values.push_back(values_with(own_, listed, point));
      }
      for (const std::string& name : listed.names) {
        if (std::find(varied_.begin(), varied_.end(), name) == varied_.end()) varied_.push_back(name);
      }
    } else if (points_.count() == 0) {
      points_.values.push_back(own_.values.front());
    }
    if (key == keys[0]) learnt_ = points_.count();
  }
}

FullOrderRuns::FullOrderRuns(const Teuchos::ParameterList& input, const Teuchos::ParameterList& block,
                             const Settings& settings, const Teuchos::RCP<const Communicator>& communicator)
    : input_(input),
      settings_(settings),
      communicator_(communicator),
      method_(block, Method::Context{input, communicator}),
      data_hashes_(reduction_identity::data_hashes(input.sublist("model"), *communicator)),
      reference_("kiln::rom::initial state", local_size(*model()->sources()) * model()->fields().size()),
      snapshots_(method_.row_size()) {
  collect_points(block);
  // It asks for the form of the Jacobian that it is to use.
  static_cast<void>(scheme());
}

std::unique_ptr<TimeScheme> FullOrderRuns::scheme() {
  return Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"),
                                      TimeScheme::Context{method_, settings_.span.step});
}

void FullOrderRuns::run() {
  model()->initial_state(reference_);
  questions_ = questions_of(input_, *model());
  if (settings_.hold) snapshots_.limit(*settings_.hold, communicator_);
  snapshots_.reserve(learnt_ * ((settings_.span.last_step + settings_.every - 1) / settings_.every));
  for (std::size_t point = 0; point < points_.count(); ++point) run_at(point);
  std::sort(extremes_.begin(), extremes_.end());
  extremes_.erase(std::unique(extremes_.begin(), extremes_.end()), extremes_.end());
  go_home();
}

void FullOrderRuns::run_at(std::size_t point) {
  method_.forget();
  points_.set(point, method_.parameters());

  TrialReference trial{{}, questions_.particles(), {}, {}, Snapshots(method_.row_size())};
  if (!varied_.empty()) trial.point = points_.part(point, 1);
  const int last = settings_.span.last_step;
  const int moments = std::min(last, trial_moments);
  for (int k = 1; k <= moments; ++k) {
    trial.steps.push_back(static_cast<int>(static_cast<long long>(last) * k / moments));
  }
  QueryRecord record(method_, trial.queries);
  StateRecord states(method_, trial.steps, trial.states);
  SnapshotRecord every(method_, snapshots_, settings_.every);
  ExtremeRecord extremes(method_);
  const std::string label = points_.count() == 1 ? std::string("full order")
                                                 : fmt::format("full order, point {}/{}", point + 1, points_.count());
  ProgressObserver progress(label, 0, *communicator_);
  std::vector<StepListener*> listeners{&record, &states};
  if (point < learnt_) listeners.insert(listeners.end(), {&every, &extremes});
  if (!settings_.quiet) listeners.push_back(&progress);

  VectorView x("kiln::rom::unknown", method_.row_size());
  method_.initial(x);
  const std::unique_ptr<TimeScheme> scheme = this->scheme();
  scheme->start(x, 0.0);
  totals_.push_back(run_time_loop(method_, *scheme, x, settings_.span, listeners));
  const std::vector<GlobalIndex> found = extremes.ids();
  extremes_.insert(extremes_.end(), found.begin(), found.end());
  trial.query_values = record.values();
  trials_.push_back(std::move(trial));
}

nlohmann::json FullOrderRuns::values(std::size_t point) const {
  nlohmann::json values = nlohmann::json::object();
  for (const std::string& name : varied_) {
    const auto place = std::find(points_.names.begin(), points_.names.end(), name) - points_.names.begin();
    values[name] = points_.values[point][place];
  }
  return values;
}

}  // namespace kiln
