#include "framework/time/MultistepCoefficients.hpp"

#include <fmt/format.h>

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace kiln {
namespace {

/// Relative size below which a sum of coefficients that the user typed with a few decimals counts as zero.
constexpr double round_off = 1e-9;
/// Distance at which numerically computed roots count as one, or as lying on the unit circle.
constexpr double root_tolerance = 1e-6;

double power(double base, int exponent) { return exponent == 0 ? 1.0 : std::pow(base, exponent); }

/// Σ α_j (−j)^q − q Σ β_j (−j)^{q−1}, relative to the sum of its terms' sizes.
double order_condition(const MultistepCoefficients& scheme, int q) {
  double sum = 0.0, size = 0.0;
  for (std::size_t j = 0; j < scheme.alpha.size(); ++j) {
    const double node = -static_cast<double>(j);
    const double alpha = scheme.alpha[j] * power(node, q);
    const double beta = q == 0 ? 0.0 : q * scheme.beta[j] * power(node, q - 1);
    sum += alpha - beta;
    size += std::abs(alpha) + std::abs(beta);
  }
  return size == 0.0 ? 0.0 : sum / size;
}

/// Roots of Σ α_j z^{k−j}: eigenvalues of its companion matrix.
std::vector<std::complex<double>> roots(const std::vector<double>& alpha) {
  const int k = static_cast<int>(alpha.size()) - 1;
  std::vector<double> companion(static_cast<std::size_t>(k * k), 0.0), real(k), imaginary(k), work(4 * k);
  for (int j = 0; j < k; ++j) companion[j * k] = -alpha[j + 1] / alpha[0];
  for (int j = 0; j + 1 < k; ++j) companion[j * k + j + 1] = 1.0;
  int info = 0;
  Teuchos::LAPACK<int, double>().GEEV('N', 'N', k, companion.data(), k, real.data(), imaginary.data(), nullptr, 1,
                                      nullptr, 1, work.data(), static_cast<int>(work.size()), nullptr, &info);
  if (info != 0) throw std::runtime_error(fmt::format("LAPACK's geev failed with info = {}", info));
  std::vector<std::complex<double>> result;
  for (int j = 0; j < k; ++j) result.emplace_back(real[j], imaginary[j]);
  return result;
}

/// A text for the first root that breaks zero-stability; empty for a stable scheme.
std::string unstable_root(const std::vector<double>& alpha) {
  const std::vector<std::complex<double>> all = roots(alpha);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double size = std::abs(all[i]);
    if (size > 1.0 + root_tolerance) return fmt::format("a root of size {:.6g}", size);
    // A double root splits by the square root of round-off when it is computed.
    const bool on_rim = size > 1.0 - std::sqrt(root_tolerance);
    for (std::size_t j = 0; j < i; ++j) {
      if (on_rim && std::abs(all[i] - all[j]) < std::sqrt(root_tolerance)) {
        return fmt::format("a multiple root of size {:.6g}", size);
      }
    }
  }
  return {};
}

}  // namespace

bool MultistepCoefficients::uses_earlier_rates() const {
  return std::any_of(beta.begin() + 1, beta.end(), [](double value) { return value != 0.0; });
}

int MultistepCoefficients::order() const {
  int q = 0;
  // 2k + 2 free coefficients up to scale: no scheme of k steps has an order beyond 2k.
  while (q <= static_cast<int>(2 * steps()) && std::abs(order_condition(*this, q)) < round_off) ++q;
  return q - 1;
}

std::vector<Problem> MultistepCoefficients::problems() const {
  std::vector<Problem> found;
  for (const auto* list : {&alpha, &beta}) {
    for (double value : *list) {
      if (!std::isfinite(value)) {
        found.push_back(
            {list == &alpha ? "alpha" : "beta", fmt::format("{} is not finite", value), "finite numbers", {}});
      }
    }
  }
  if (alpha.size() < 2) {
    found.push_back(
        {"alpha", fmt::format("there are {} coefficients", alpha.size()), "at least alpha_0 and alpha_1", {}});
  }
  if (alpha.size() != beta.size()) {
    found.push_back({"beta",
                     fmt::format("there are {} coefficients", beta.size()),
                     fmt::format("as many as alpha has: {}", alpha.size()),
                     {}});
  }
  if (!found.empty()) return found;
  if (alpha[0] == 0.0) {
    found.push_back({"alpha", "alpha_0 is 0", "a coefficient of the new state other than 0", {}});
    return found;
  }
  if (std::abs(order_condition(*this, 0)) > round_off) {
    double sum = 0.0;
    for (double value : alpha) sum += value;
    found.push_back({"alpha",
                     fmt::format("the coefficients add up to {:.6g}: the scheme is not consistent", sum),
                     "a sum of 0",
                     {}});
  }
  if (std::abs(order_condition(*this, 1)) > round_off) {
    double weighted = 0.0, sum = 0.0;
    for (std::size_t j = 0; j < alpha.size(); ++j) {
      weighted -= static_cast<double>(j) * alpha[j];
      sum += beta[j];
    }
    found.push_back({"beta",
                     fmt::format("the coefficients add up to {:.6g}: the scheme is not consistent", sum),
                     fmt::format("-sum of j alpha_j = {:.6g}", weighted),
                     {}});
  }
  const std::string root = unstable_root(alpha);
  if (!root.empty()) {
    found.push_back({"alpha",
                     fmt::format("the polynomial of the coefficients has {}: the scheme is not zero-stable", root),
                     "roots in the unit disc, simple on its rim",
                     {}});
  }
  return found;
}

}  // namespace kiln
