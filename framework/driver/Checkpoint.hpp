#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "framework/method/SolveTotals.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/time/TimeScheme.hpp"

namespace kiln {

/// Writes the state of a run into one file at the moments that say so, which is replaced in one stroke: whenever a run
/// dies, the last complete checkpoint is there. A run that restarts from it on the same number of ranks goes on bit by
/// bit as if it had never stopped.
class Checkpoint : public Observer {
 public:
  /// What a run that goes on begins with.
  struct Resumed {
    int step = 0;
    SolveTotals solved;  ///< of the steps so far
  };

  /// `identity` is the text of what must agree between the runs: model, time and method. `solved`: before the first
  /// step.
  Checkpoint(const Context& context, TimeScheme& scheme, std::string identity, const SolveTotals& solved);

  void begin() override {}
  void observe(const Moment& moment) override;
  void finish(RunReport& report) override;

  static std::filesystem::path file(const std::filesystem::path& folder) { return folder / "checkpoint.h5"; }

  /// Takes x, the scheme's history and the method's solver state from the checkpoint in `folder`, whose step is at most
  /// `last_step`. Throws FileError for a missing or damaged file and for one of another run, naming the first line of
  /// `identity` that differs.
  static Resumed restore(const std::filesystem::path& folder, const std::string& identity, Method& method,
                         TimeScheme& scheme, VectorView x, int last_step,
                         const Teuchos::RCP<const Communicator>& communicator);

 private:
  Method& method_;
  TimeScheme& scheme_;
  Teuchos::RCP<const Communicator> communicator_;
  std::filesystem::path folder_;
  std::string identity_;
  SolveTotals solved_;
  std::uint64_t room_;  ///< bytes that the next one may take
  int written_ = 0;
};

}  // namespace kiln
