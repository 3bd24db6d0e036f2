#pragma once

#include <Teuchos_ParameterList.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/time/TimeLoop.hpp"
#include "framework/time/TimeScheme.hpp"
#include "rom/files/Reduction.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/projection/PetrovGalerkin.hpp"
#include "rom/training/FullOrderRuns.hpp"
#include "rom/training/LearntStates.hpp"

namespace kiln {

/// The third stage of procedure II: marches LSPG without hyper-reduction through the time windows, at every point that
/// is learnt from, and learns each window's sample mesh from the residuals it meets there.
class LearnWindows {
 public:
  struct Settings {
    const Teuchos::ParameterList& input;  ///< the whole checked input
    const Teuchos::ParameterList& block;  ///< `reduction`
    TimeSpan span;
    PodSettings residual_basis;
    bool quiet;  ///< no progress bar
  };
  /// `lspg`: on all rows, with the bases of the windows.
  LearnWindows(const Settings& settings, const FullOrderRuns& full_order, PetrovGalerkin& lspg);

  /// `ends`: steps at which windows end; `bases`: one a window. Adds residual_basis, sample_meshes, clusters and lspg
  /// to `facts`. Collective.
  std::vector<WindowReduction> learn(const std::vector<int>& ends, std::vector<Pod> bases, nlohmann::json& facts);
  /// What is to be told of the sample meshes.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  /// One point's way through the windows.
  struct Marcher {
    VectorView x;
    std::unique_ptr<TimeScheme> scheme;
  };
  std::vector<Marcher> marchers() const;
  /// Takes all points through a window; their residuals become snapshots. Returns what the clustering wants to know:
  /// states at the window's beginning and at clustering_steps(). Leaves the model with the input's own parameters.
  LearntStates march(std::vector<Marcher>& marchers, std::size_t window, int first_step, int last_step,
                     const std::string& label);
  WindowReduction learn_window(double end, Pod basis);
  void add_clusters(std::vector<WindowReduction>& windows, const LearntStates& states, nlohmann::json& facts) const;
  void check(const WindowReduction& window);
  bool clusters() const { return settings_.block.isSublist("clustering"); }

  Settings settings_;
  const FullOrderRuns& full_order_;
  PetrovGalerkin& lspg_;
  Teuchos::RCP<const Communicator> communicator_;
  Snapshots residuals_;
  LoopTotals totals_;
  std::vector<std::string> warnings_;
};

}  // namespace kiln
