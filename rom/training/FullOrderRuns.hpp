#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/method/FullOrder.hpp"
#include "framework/registry/Specification.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/files/Questions.hpp"
#include "rom/pod/Snapshots.hpp"
#include "rom/training/TrialRun.hpp"

namespace kiln {

/// The full-order runs of a training, a run for each point of the model's live parameters: those the reduction learns
/// from and those it is only tried on. Without any, one run with the input's own values.
class FullOrderRuns {
 public:
  struct Settings {
    TimeSpan span;
    int every;                ///< steps between two snapshots
    std::optional<int> hold;  ///< most snapshots held in memory
    bool quiet;               ///< no progress bar
  };
  /// Adds the keys `train_on` and `try_on` to the block `reduction`.
  static void specify(Specification& reduction);

  /// Makes the model. Throws InputError for points that are none of the model's, and for a form of the Jacobian that it
  /// lacks. Collective.
  FullOrderRuns(const Teuchos::ParameterList& input, const Teuchos::ParameterList& block, const Settings& settings,
                const Teuchos::RCP<const Communicator>& communicator);
  /// Runs them all; what is told below of runs stands after it. Collective.
  void run();

  const std::shared_ptr<Model>& model() const { return method_.model(); }
  /// reduction_identity::data_hashes() when the model was made.
  const std::map<std::string, std::string>& data_hashes() const { return data_hashes_; }
  /// u_0 at the model's sources.
  const VectorView& reference() const { return reference_; }
  /// How many of the points the reduction learns from, at least one; they come first.
  std::size_t learnt() const { return learnt_; }
  /// All live parameters at each point.
  const ParameterPoints& parameters() const { return points_; }
  /// Gives the model's live parameters their values at a point.
  void go_to(std::size_t point) const { points_.set(point, model()->parameters()); }
  /// Gives them the input's own values.
  void go_home() const { own_.set(0, model()->parameters()); }

  /// What online runs must be able to tell.
  const Questions& questions() const { return questions_; }
  /// u − u_0 of the points learnt from, one run after the other.
  Snapshots& snapshots() { return snapshots_; }
  /// What a trial at a point is measured against.
  const TrialReference& trial(std::size_t point) const { return trials_[point]; }
  std::size_t points() const { return trials_.size(); }
  /// The values of the parameters that vary, by name; empty where none does.
  nlohmann::json values(std::size_t point) const;
  /// Where a component was highest or lowest after any step of the runs learnt from: ids, ascending.
  const std::vector<GlobalIndex>& extremes() const { return extremes_; }
  /// Steps and evaluations of each run.
  const std::vector<LoopTotals>& totals() const { return totals_; }

 private:
  void collect_points(const Teuchos::ParameterList& block);
  void run_at(std::size_t point);
  std::unique_ptr<TimeScheme> scheme();

  const Teuchos::ParameterList& input_;
  Settings settings_;
  Teuchos::RCP<const Communicator> communicator_;
  FullOrder method_;
  std::map<std::string, std::string> data_hashes_;
  ParameterPoints points_;           ///< all live parameters at each point
  ParameterPoints own_;              ///< the same of the input
  std::vector<std::string> varied_;  ///< names of the parameters that points list
  std::size_t learnt_ = 1;
  VectorView reference_;
  Questions questions_;
  Snapshots snapshots_;
  std::vector<TrialReference> trials_;
  std::vector<GlobalIndex> extremes_;
  std::vector<LoopTotals> totals_;
};

}  // namespace kiln
