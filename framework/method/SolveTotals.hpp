#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/method/StepResidual.hpp"

namespace kiln {

/// Sums of the solve reports of a run's steps.
struct SolveTotals {
  long long steps = 0;
  long long residuals = 0;
  long long iterations = 0;
  long long capped_steps = 0;  ///< steps whose iteration cap came before convergence
  double most_left = 0.0;      ///< the largest of their last residuals, as a fraction of the step's first

  void add(const SolveReport& solve);
  SolveTotals& operator+=(const SolveTotals& other);
  /// The section `solve` of a report: these sums, and residuals and iterations a step.
  nlohmann::json facts() const;
  /// A sentence where steps were left unsolved; none otherwise.
  std::vector<std::string> warnings() const;
};

}  // namespace kiln
