#include "framework/method/SolveTotals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace kiln {

void SolveTotals::add(const SolveReport& solve) {
  ++steps;
  residuals += solve.residuals;
  iterations += solve.iterations;
  if (solve.converged) return;
  ++capped_steps;
  if (solve.first_norm > 0.0) most_left = std::max(most_left, solve.last_norm / solve.first_norm);
}

SolveTotals& SolveTotals::operator+=(const SolveTotals& other) {
  steps += other.steps;
  residuals += other.residuals;
  iterations += other.iterations;
  capped_steps += other.capped_steps;
  most_left = std::max(most_left, other.most_left);
  return *this;
}

nlohmann::json SolveTotals::facts() const {
  const auto each = static_cast<double>(std::max(steps, 1LL));
  return {{"steps", steps},
          {"residuals", residuals},
          {"residuals_per_step", static_cast<double>(residuals) / each},
          {"iterations", iterations},
          {"iterations_per_step", static_cast<double>(iterations) / each},
          {"capped_steps", capped_steps},
          {"most_left", most_left}};
}

std::vector<std::string> SolveTotals::warnings() const {
  if (capped_steps == 0) return {};
  return {
      fmt::format("{} of {} steps were left unsolved at the cap of iterations, with up to {:.2g} % of their first "
                  "residual: more time.newton.iterations, shorter steps, or another time.newton.jacobian or refresh "
                  "may solve them",
                  capped_steps, steps, 100.0 * most_left)};
}

}  // namespace kiln
