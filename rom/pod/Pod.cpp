#include "rom/pod/Pod.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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
  dense::sum_over_ranks(communicator, small.to_modes.data(), small.to_modes.size());
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

/// S = QR and R = U Σ Vᵀ, so Φ = Q U.
Small small_half_of_tsqr(const Tsqr& factors, const Communicator& communicator) {
  Small small;
  const std::size_t rank = std::min(factors.r().extent(0), factors.r().extent(1));
  small.singular_values.resize(rank);
  small.to_modes = MatrixView("kiln::rom::left singular vectors", factors.r().extent(0), rank);
  if (communicator.getRank() == 0) {
    const dense::Svd svd = dense::svd(factors.r());
    small.singular_values = svd.values;
    Kokkos::deep_copy(small.to_modes, svd.left);
    for (std::size_t k = 0; k < rank; ++k) {
      scale_column(small.to_modes, k,
                   sign_of_largest(svd.right_transposed.data() + k, svd.right_transposed.extent(1), rank));
    }
  }
  return small;
}

double loss_of_orthogonality(const MatrixView& modes, const Communicator& communicator) {
  const MatrixView products = dense::gram(modes);
  dense::sum_over_ranks(communicator, products.data(), products.size());
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
  if (settings.algorithm == PodSettings::Algorithm::tsqr) factors.emplace(matrix, communicator);
  Small small = factors ? small_half_of_tsqr(*factors, communicator) : small_half_of_gram(matrix, communicator);
  dense::broadcast(communicator, small.singular_values.data(), small.singular_values.size());
  dense::broadcast(communicator, small.to_modes.data(), small.to_modes.size());

  Pod result{{}, small.singular_values, truncate(small.singular_values, settings), 0.0, false};
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
