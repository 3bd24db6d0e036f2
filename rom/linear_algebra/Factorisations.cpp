#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "rom/linear_algebra/Dense.hpp"

// Divide-and-conquer drivers that Teuchos::LAPACK lacks; an order of magnitude faster than SYEV and GESVD at thousands
// of columns.
extern "C" {
void dsyevd_(const char* job, const char* triangle, const int* n, double* a, const int* lda, double* values,
             double* work, const int* work_size, int* integer_work, const int* integer_work_size, int* info);
void dgesdd_(const char* job, const int* m, const int* n, double* a, const int* lda, double* values, double* u,
             const int* ldu, double* vt, const int* ldvt, double* work, const int* work_size, int* integer_work,
             int* info);
}

namespace kiln::dense {
namespace {

using Lapack = Teuchos::LAPACK<int, double>;

int leading_dimension(const ConstMatrixView& a) { return std::max<int>(1, std::max<int>(a.extent(0), a.stride(1))); }

void require(int info, const char* routine) {
  if (info != 0) throw std::runtime_error(std::string("LAPACK ") + routine + " returned " + std::to_string(info));
}

MatrixView copy_of(const ConstMatrixView& a) {
  MatrixView copy(Kokkos::view_alloc(Kokkos::WithoutInitializing, "kiln::rom::copy"), a.extent(0), a.extent(1));
  for (std::size_t j = 0; j < a.extent(1); ++j) std::copy_n(&a(0, j), a.extent(0), &copy(0, j));
  return copy;
}

}  // namespace

Svd svd(const ConstMatrixView& a) {
  const int m = static_cast<int>(a.extent(0)), n = static_cast<int>(a.extent(1)), k = std::min(m, n);
  Svd result{MatrixView("kiln::rom::left singular vectors", m, k), std::vector<double>(k),
             MatrixView("kiln::rom::right singular vectors", k, n)};
  if (k == 0) return result;
  MatrixView work_copy = copy_of(a);
  std::vector<int> integer_work(8 * k);
  double best = 0.0;
  int info = 0;
  for (const bool query : {true, false}) {
    std::vector<double> work(query ? 1 : static_cast<std::size_t>(best));
    const int work_size = query ? -1 : static_cast<int>(work.size());
    dgesdd_("S", &m, &n, work_copy.data(), &m, result.values.data(), result.left.data(), &m,
            result.right_transposed.data(), &k, work.data(), &work_size, integer_work.data(), &info);
    require(info, "dgesdd");
    best = work[0];
  }
  return result;
}

std::vector<double> symmetric_eigen(const MatrixView& a) {
  const int n = static_cast<int>(a.extent(0)), lda = leading_dimension(a);
  std::vector<double> values(n);
  if (n == 0) return values;
  std::size_t work_size = 1, integer_work_size = 1;
  int info = 0;
  for (const bool query : {true, false}) {
    std::vector<double> work(work_size);
    std::vector<int> integer_work(integer_work_size);
    const int sizes[] = {query ? -1 : static_cast<int>(work_size), query ? -1 : static_cast<int>(integer_work_size)};
    dsyevd_("V", "U", &n, a.data(), &lda, values.data(), work.data(), &sizes[0], integer_work.data(), &sizes[1], &info);
    require(info, "dsyevd");
    work_size = static_cast<std::size_t>(work[0]);
    integer_work_size = integer_work[0];
  }
  std::reverse(values.begin(), values.end());
  for (int j = 0; j < n / 2; ++j) std::swap_ranges(&a(0, j), &a(0, j) + n, &a(0, n - 1 - j));
  return values;
}

HouseholderQr::HouseholderQr(MatrixView a)
    : factors_(std::move(a)), tau_(std::min(factors_.extent(0), factors_.extent(1))) {
  if (tau_.empty()) return;
  const int m = static_cast<int>(factors_.extent(0)), n = static_cast<int>(factors_.extent(1));
  double best = 0.0;
  int info = 0;
  Lapack().GEQRF(m, n, factors_.data(), leading_dimension(factors_), tau_.data(), &best, -1, &info);
  std::vector<double> work(static_cast<std::size_t>(best));
  Lapack().GEQRF(m, n, factors_.data(), leading_dimension(factors_), tau_.data(), work.data(),
                 static_cast<int>(work.size()), &info);
  require(info, "dgeqrf");
}

MatrixView HouseholderQr::r() const {
  MatrixView result("kiln::rom::R", tau_.size(), factors_.extent(1));
  for (std::size_t j = 0; j < factors_.extent(1); ++j) {
    for (std::size_t i = 0; i < std::min(tau_.size(), j + 1); ++i) result(i, j) = factors_(i, j);
  }
  return result;
}

void HouseholderQr::apply_q(const MatrixView& b) const {
  if (tau_.empty() || b.extent(1) == 0) return;
  const int m = static_cast<int>(b.extent(0)), n = static_cast<int>(b.extent(1));
  double best = 0.0;
  int info = 0;
  const auto apply = [&](double* work, int work_size) {
    Lapack().ORMQR('L', 'N', m, n, static_cast<int>(tau_.size()), const_cast<double*>(factors_.data()),
                   leading_dimension(factors_), tau_.data(), b.data(), leading_dimension(b), work, work_size, &info);
    require(info, "dormqr");
  };
  apply(&best, -1);
  std::vector<double> work(static_cast<std::size_t>(best));
  apply(work.data(), static_cast<int>(work.size()));
}

double LuFactors::factor(const MatrixView& a) {
  factors_ = a;
  const int n = static_cast<int>(a.extent(0));
  pivots_.resize(n);
  double norm = 0.0;
  for (int j = 0; j < n; ++j) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += std::abs(a(i, j));
    if (!std::isfinite(sum)) return 0.0;
    norm = std::max(norm, sum);
  }
  int info = 0;
  Lapack().GETRF(n, n, factors_.data(), leading_dimension(factors_), pivots_.data(), &info);
  return info == 0 ? reciprocal_condition(norm) : 0.0;
}

double LuFactors::reciprocal_condition(double norm) {
  const int n = static_cast<int>(factors_.extent(0));
  if (n > largest_inverse) {
    inverse_transposed_ = {};
    std::vector<double> work(4 * n);
    std::vector<int> integer_work(n);
    double reciprocal = 0.0;
    int info = 0;
    Lapack().GECON('1', n, factors_.data(), leading_dimension(factors_), norm, &reciprocal, work.data(),
                   integer_work.data(), &info);
    return info == 0 ? reciprocal : 0.0;
  }
  if (static_cast<int>(inverse_transposed_.extent(0)) != n) {
    inverse_transposed_ = MatrixView("kiln::rom::transposed inverse", n, n);
  }
  right_.resize(n);
  invert(inverse_transposed_);
  double inverse_norm = 0.0;
  for (int j = 0; j < n; ++j) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += std::abs(inverse_transposed_(j, i));
    if (!std::isfinite(sum)) return 0.0;
    inverse_norm = std::max(inverse_norm, sum);
  }
  return norm > 0.0 ? 1.0 / (norm * inverse_norm) : n == 0 ? 1.0 : 0.0;
}

void LuFactors::solve(const VectorView& b) const {
  const int n = static_cast<int>(factors_.extent(0));
  if (inverse_transposed_.extent(0) == factors_.extent(0)) {
    std::copy_n(b.data(), n, right_.data());
    return transposed(inverse_transposed_, right_.data(), b.data());
  }
  int info = 0;
  Lapack().GETRS('N', n, 1, factors_.data(), leading_dimension(factors_), pivots_.data(), b.data(), n, &info);
}

void LuFactors::inverse_transposed(const MatrixView& result) const {
  if (inverse_transposed_.extent(0) != factors_.extent(0)) return invert(result);
  Kokkos::deep_copy(result, inverse_transposed_);
}

void LuFactors::invert(const MatrixView& result) const {
  const int n = static_cast<int>(factors_.extent(0));
  Kokkos::deep_copy(result, 0.0);
  for (int k = 0; k < n; ++k) result(k, k) = 1.0;
  int info = 0;
  Lapack().GETRS('T', n, n, factors_.data(), leading_dimension(factors_), pivots_.data(), result.data(),
                 leading_dimension(result), &info);
}

}  // namespace kiln::dense
