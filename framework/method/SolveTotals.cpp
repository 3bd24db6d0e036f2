#include "framework/method/SolveTotals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace kiln {

void SolveTotals::add(const SolveReport& solve) {
  ++steps;
  residuals += solve.residuals;
  iterations += solve.iterations;
  capped_steps += solve.converged ? 0 : 1;
}

SolveTotals& SolveTotals::operator+=(const SolveTotals& other) {
  steps += other.steps;
  residuals += other.residuals;
  iterations += other.iterations;
  capped_steps += other.capped_steps;
  return *this;
}

nlohmann::json SolveTotals::facts() const {
  const auto each = static_cast<double>(std::max(steps, 1LL));
  return {{"steps", steps},
          {"residuals", residuals},
          {"residuals_per_step", static_cast<double>(residuals) / each},
          {"iterations", iterations},
          {"iterations_per_step", static_cast<double>(iterations) / each},
          {"capped_steps", capped_steps}};
}

std::vector<std::string> SolveTotals::warnings() const {
  if (capped_steps == 0) return {};
  return {
      fmt::format("{} of {} steps were left unsolved at the cap of iterations, so that their answers are off: take "
                  "more time.newton.iterations, shorter steps, or another time.newton.jacobian or refresh",
                  capped_steps, steps)};
}

}  // namespace kiln
