#pragma once

#include "rom/linear_algebra/Dense.hpp"

namespace kiln {

/// Thin QR of a tall matrix whose rows are spread over ranks: a Householder QR on each rank, then one of the ranks'
/// stacked R (Demmel, Grigori, Hoemmen, Langou 2012, with a flat tree). Ranks may hold fewer rows than there are
/// columns, or none.
class Tsqr {
 public:
  /// Overwrites `a`, this rank's rows, and keeps it. Collective.
  Tsqr(MatrixView a, const Communicator& communicator);

  /// R with non-negative diagonal, min(all rows, columns) × columns, the same on every rank.
  const MatrixView& r() const { return r_; }
  /// This rank's rows of Q c; c: rows of R × k.
  MatrixView apply(const ConstMatrixView& c) const;

 private:
  dense::HouseholderQr local_;
  std::size_t rows_;
  MatrixView r_;
  MatrixView stacked_q_;  ///< this rank's block of the second factorisation's Q
};

/// Replaces the columns of `a` by an orthonormal basis of their nested spans, each close to the column it replaces when
/// the columns are nearly orthonormal. Collective.
void orthonormalise(const MatrixView& a, const Communicator& communicator);

}  // namespace kiln
