#pragma once

#include <Teuchos_StackedTimer.hpp>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Measures a stage: wall seconds and the processor seconds of all threads of all ranks.
class Stopwatch {
 public:
  /// Starts now.
  Stopwatch();
  double wall_seconds() const;
  /// User and system time of this process's threads since the start.
  double process_seconds() const;
  /// Summed over ranks. Collective.
  double cpu_seconds(const Communicator& communicator) const;

 private:
  double wall_start_;
  double process_start_;
};

/// Largest memory any rank has held since its start or the last reset_peak_memory(), in bytes. Collective.
long long peak_memory(const Communicator& communicator);
/// Gives freed memory back to the system and lets peak_memory() begin anew: for several runs in one process. A system
/// that does not allow it keeps the old peak.
void reset_peak_memory();

/// While it lives, collects all Teuchos::TimeMonitor regions into one stacked timer. One at a time.
class Timers {
 public:
  explicit Timers(const std::string& name);
  ~Timers();
  Timers(const Timers&) = delete;
  Timers& operator=(const Timers&) = delete;
  /// Stops and returns table_of() it. Collective.
  std::string table(const Teuchos::RCP<const Communicator>& communicator) const;

 private:
  Teuchos::RCP<Teuchos::StackedTimer> timer_;
};

/// The timer's table with minimum, mean and maximum over the ranks; on rank 0, empty elsewhere. The timer is stopped
/// already. Collective.
std::string table_of(Teuchos::StackedTimer& timer, const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
