#pragma once

#include <vector>

namespace kiln {

/// Least-squares problems min ‖A[:, 0:b] α − A[:, q]‖ for a matrix A that gains rows and whose leading block gains
/// columns: the QR factors are updated by Givens rotations and Householder reflections, never computed anew. All right
/// sides are columns of A itself, known from the start. O(rows · columns²) in all.
class GrowingLeastSquares {
 public:
  explicit GrowingLeastSquares(int columns) : columns_(columns) {}

  /// `row`: one value a column.
  void add_row(std::vector<double> row);
  /// Takes the next column into the leading block. Throws std::logic_error if there are no more rows than columns in
  /// it.
  void add_column();
  int leading() const { return leading_; }
  /// α of column q; entries of directions that the rows do not see are zero.
  std::vector<double> solve(int q) const;

 private:
  int columns_;
  int leading_ = 0;
  std::vector<std::vector<double>> rows_;  ///< Qᵀ A: upper triangular in the leading block
};

}  // namespace kiln
