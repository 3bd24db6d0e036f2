#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kiln {

/// Offered beside Model by physics that sum up, over the rates asked for in a run, what a user is to know of it: what a
/// heat source has deposited, say.
class SumsOverRun {
 public:
  virtual ~SumsOverRun() = default;

  /// The sums begin anew.
  virtual void begin_run() = 0;
  /// What the run report should say of them, e.g. {"mean_absorbed_watt", 19.98}, over all ranks. Collective.
  virtual std::vector<std::pair<std::string, double>> run_facts() const = 0;
  /// What a user is to know before the run is believed, a sentence each, e.g. that a heat source has heated nothing.
  /// The same on every rank. Collective.
  virtual std::vector<std::string> warnings() const = 0;
};

}  // namespace kiln
