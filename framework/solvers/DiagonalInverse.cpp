#include "framework/solvers/DiagonalInverse.hpp"

#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <stdexcept>

namespace kiln {

DiagonalInverse::DiagonalInverse(const Vector& diagonal) : inverse_(diagonal.getMap()) {
  inverse_.reciprocal(diagonal);
}

void DiagonalInverse::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha, double beta) const {
  y.elementWiseMultiply(alpha, inverse_, x, beta);
}

}  // namespace kiln
