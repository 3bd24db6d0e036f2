#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/method/Method.hpp"

namespace kiln {

class RunReport;

/// Where a run stands when observers are called.
struct Moment {
  int step;           ///< 0: initial state
  int last_step;      ///< number of the run's last step
  double time;        ///< in s
  ConstVectorView x;  ///< the method's unknown; the next step changes it
  SolveReport solve;  ///< of this step; empty at step 0
  /// A checkpoint of this step is written after the other observers have seen it: a run that restarts from it needs all
  /// they have observed so far on the disk.
  bool checkpoint = false;
};

/// Looks at a run after its initial state and after every step: writes fields, probes, checkpoints, collects snapshots.
/// Calls are collective. Registered observers are blocks of `output:` in the input, by their name. Constructors check
/// and throw; files are made or changed by `begin`, when every observer of the run has passed, so that a mistake in one
/// block never costs the results of an earlier run.
class Observer {
 public:
  struct Context {
    Method& method;
    std::filesystem::path folder;  ///< of this run's outputs, existing and writable
    Teuchos::RCP<const Communicator> communicator;
    int first_step;  ///< 0, or the step of the checkpoint a restarted run continues from
    int last_step;
    double step;  ///< Δt in s
    /// What outputs say of the run besides versions and machine, e.g. "input" and "method"; attributes of its files.
    std::map<std::string, std::string> provenance = {};
  };
  static constexpr const char* category = "observer";

  virtual ~Observer() = default;
  /// Before the first moment, once, when all observers of the run have been built: makes the observer's files.
  virtual void begin() = 0;
  virtual void observe(const Moment& moment) = 0;
  /// After the last step, also of a run that diverged or was stopped: all that was observed reaches the disk, and what
  /// belongs into the run's report is added.
  virtual void finish(RunReport& report) = 0;
};

}  // namespace kiln
