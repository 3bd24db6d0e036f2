#include "rom/pod/Pod.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "framework/base/Collectives.hpp"
#include "framework/base/Loop.hpp"
#include "rom/pod/Tsqr.hpp"

namespace kiln {
namespace {

using dense::Transpose;

/// The small half of the decomposition: Σ and, column by column, the matrix that turns S (gram) or Q (tsqr) into Φ.
struct Small {
  std::vector<double> singular_values;
  MatrixView to_modes;
};

/// +1 or −1: the sign that makes the largest entry positive; of nearly equal ones the first decides.
double sign_of_largest(const double* values, std::size_t count, std::size_t stride) {
  double largest = 0.0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(values[i * stride]));
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(values[i * stride]) >= (1.0 - 1e-6) * largest) return values[i * stride] < 0.0 ? -1.0 : 1.0;
  }
  return 1.0;
}

void scale_column(const MatrixView& a, std::size_t column, double factor) {
  for (std::size_t i = 0; i < a.extent(0); ++i) a(i, column) *= factor;
}

/// SᵀS = V Σ² Vᵀ, so Φ = S V Σ⁻¹.
Small small_half_of_gram(const MatrixView& snapshots, const Communicator& communicator) {
  Small small;
  small.to_modes = dense::gram(snapshots);
  sum_over_ranks(communicator, small.to_modes.data(), small.to_modes.size());
  const std::size_t count = snapshots.extent(1);
  small.singular_values.resize(count);
  if (communicator.getRank() == 0) {
    const std::vector<double> squares = dense::symmetric_eigen(small.to_modes);
    for (std::size_t k = 0; k < count; ++k) {
      const double sigma = std::sqrt(std::max(0.0, squares[k]));
      small.singular_values[k] = sigma;
      const double sign = sign_of_largest(small.to_modes.data() + k * count, count, 1);
      scale_column(small.to_modes, k, sigma > 0.0 ? sign / sigma : 0.0);
    }
  }
  return small;
}

/// Σ and U of A = U Σ Vᵀ, U with the signs that V decides.
Small left_half(const MatrixView& a) {
  const dense::Svd svd = dense::svd(a);
  const std::size_t rank = svd.values.size();
  for (std::size_t k = 0; k < rank; ++k) {
    scale_column(svd.left, k, sign_of_largest(svd.right_transposed.data() + k, svd.right_transposed.extent(1), rank));
  }
  return {svd.values, svd.left};
}

/// S = QR and R = U Σ Vᵀ, so Φ = Q U.
Small small_half_of_tsqr(const Tsqr& factors, const Communicator& communicator) {
  Small small;
  const std::size_t rank = std::min(factors.r().extent(0), factors.r().extent(1));
  small.singular_values.resize(rank);
  small.to_modes = MatrixView("kiln::rom::left singular vectors", factors.r().extent(0), rank);
  if (communicator.getRank() == 0) small = left_half(factors.r());
  return small;
}

/// Uniform in (−1, 1), the same everywhere for the same place (SplitMix64: Steele, Lea, Flood 2014).
double random_entry(std::uint64_t place) {
  std::uint64_t z = (place + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

/// An orthonormal basis of the range of S (SᵀS)² Ω (Halko, Martinsson, Tropp 2011, Alg. 4.4).
Tsqr range_of(const MatrixView& snapshots, int rank, const Communicator& communicator) {
  constexpr int oversampling = 10, power_iterations = 2;
  const std::size_t count = snapshots.extent(1);
  const std::size_t width = std::min(count, static_cast<std::size_t>(rank + oversampling));
  const MatrixView combinations("kiln::rom::combinations", count, width);
  for (std::size_t i = 0; i < combinations.size(); ++i) combinations.data()[i] = random_entry(i);
  const MatrixView range("kiln::rom::range", snapshots.extent(0), width);
  for (int k = 0;; ++k) {
    dense::product(Transpose::no, Transpose::no, 1.0, snapshots, combinations, 0.0, range);
    if (k == power_iterations) return Tsqr(range, communicator);
    orthonormalise(range, communicator);
    dense::product(Transpose::yes, Transpose::no, 1.0, snapshots, range, 0.0, combinations);
    sum_over_ranks(communicator, combinations.data(), combinations.size());
  }
}

/// QᵀS = U Σ Vᵀ, so Φ = Q U.
Small small_half_of_projection(const Tsqr& range, const MatrixView& snapshots, const Communicator& communicator) {
  const std::size_t width = range.r().extent(0);
  MatrixView identity("kiln::rom::identity", width, width);
  for (std::size_t k = 0; k < width; ++k) identity(k, k) = 1.0;
  const MatrixView projected("kiln::rom::projected snapshots", width, snapshots.extent(1));
  dense::product(Transpose::yes, Transpose::no, 1.0, range.apply(identity), snapshots, 0.0, projected);
  sum_over_ranks(communicator, projected.data(), projected.size());
  Small small{std::vector<double>(width), MatrixView("kiln::rom::left singular vectors", width, width)};
  if (communicator.getRank() == 0) small = left_half(projected);
  return small;
}

/// Σσ² of all of S, whatever a decomposition has seen of it.
double squared_norm(const MatrixView& snapshots, const Communicator& communicator) {
  const auto rows = static_cast<LocalIndex>(snapshots.extent(0));
  double total = 0.0;
  for (std::size_t column = 0; column < snapshots.extent(1); ++column) {
    const double* entries = &snapshots(0, column);
    total += sum("kiln::rom::squared norm", rows, [entries](LocalIndex i) { return entries[i] * entries[i]; });
  }
  sum_over_ranks(communicator, &total, 1);
  return total;
}

double loss_of_orthogonality(const MatrixView& modes, const Communicator& communicator) {
  const MatrixView products = dense::gram(modes);
  sum_over_ranks(communicator, products.data(), products.size());
  double loss = 0.0;
  for (std::size_t j = 0; j < products.extent(1); ++j) {
    for (std::size_t i = 0; i < products.extent(0); ++i) {
      loss = std::max(loss, std::abs(products(i, j) - (i == j ? 1.0 : 0.0)));
    }
  }
  return loss;
}

}  // namespace

Pod pod(const Snapshots& snapshots, const PodSettings& settings, const Communicator& communicator) {
  const MatrixView matrix = snapshots.matrix();
  std::optional<Tsqr> factors;
  Small small;
  if (settings.algorithm == PodSettings::Algorithm::gram) {
    small = small_half_of_gram(matrix, communicator);
  } else if (settings.algorithm == PodSettings::Algorithm::tsqr) {
    factors.emplace(matrix, communicator);
    small = small_half_of_tsqr(*factors, communicator);
  } else {
    if (!settings.rank) throw std::logic_error("a randomised POD of no given rank");
    factors.emplace(range_of(matrix, *settings.rank, communicator));
    small = small_half_of_projection(*factors, matrix, communicator);
  }
  broadcast(communicator, 0, small.singular_values.data(), small.singular_values.size());
  broadcast(communicator, 0, small.to_modes.data(), small.to_modes.size());

  const std::size_t count = snapshots.appended();
  Pod result{
      {},   small.singular_values, truncate(small.singular_values, count, settings, snapshots.count()), count, 0.0,
      false};
  if (settings.algorithm == PodSettings::Algorithm::randomised) {
    double kept = 0.0;
    for (int k = 0; k < result.truncation.rank; ++k) kept += std::pow(small.singular_values[k], 2);
    result.truncation.energy = kept / squared_norm(matrix, communicator);
  }
  const ConstMatrixView kept = dense::leading_columns(ConstMatrixView(small.to_modes), result.truncation.rank);
  if (factors) {
    result.modes = factors->apply(kept);
  } else {
    result.modes = MatrixView("kiln::rom::modes", matrix.extent(0), result.truncation.rank);
    dense::product(Transpose::no, Transpose::no, 1.0, matrix, kept, 0.0, result.modes);
  }
  result.orthogonality = loss_of_orthogonality(result.modes, communicator);
  if (result.orthogonality > 1e-10) {
    orthonormalise(result.modes, communicator);
    result.orthogonality = loss_of_orthogonality(result.modes, communicator);
    result.reorthogonalised = true;
  }
  return result;
}

}  // namespace kiln
