#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/method/Method.hpp"
#include "framework/time/StepListener.hpp"

namespace kiln {

class RunReport;

/// A listener that also works before the first moment and after the last: writes fields, probes, checkpoints. Calls are
/// collective. Registered observers are blocks of `output:` in the input, by their name. Constructors check and throw;
/// files are made or changed by `begin`, when every observer of the run has passed, so that a mistake in one block
/// never costs the results of an earlier run.
class Observer : public StepListener {
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

  /// Before the first moment, once, when all observers of the run have been built: makes the observer's files.
  virtual void begin() = 0;
  /// After the last step, also of a run that diverged or was stopped: all that was observed reaches the disk, and what
  /// belongs into the run's report is added.
  virtual void finish(RunReport& report) = 0;
};

}  // namespace kiln
