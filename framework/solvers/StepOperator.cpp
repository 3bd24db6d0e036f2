#include "framework/solvers/StepOperator.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

void combine(double scale_x, const ConstMatrixView& x, double scale_product, const ConstMatrixView& product,
             double scale_y, const MatrixView& y) {
  for (std::size_t column = 0; column < y.extent(1); ++column) {
    Kokkos::parallel_for(
        "kiln::solvers::combine", RangePolicy(0, static_cast<LocalIndex>(y.extent(0))),
        KOKKOS_LAMBDA(const LocalIndex i) {
          // y may hold anything, NaN too, when it is to be overwritten.
          const double kept = scale_y == 0.0 ? 0.0 : scale_y * y(i, column);
          y(i, column) = kept + scale_x * x(i, column) + scale_product * product(i, column);
        });
  }
}

}  // namespace

void StepOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha, double beta) const {
  if (mode != Teuchos::NO_TRANS) throw NotOffered("kiln::StepOperator", "a transposed application");
  const std::size_t columns = x.getNumVectors();
  if (sources_.is_null() || sources_->getNumVectors() != columns) {
    sources_ = Teuchos::rcp(new MultiVector(halo_.sources(), columns));
    product_ = MatrixView("kiln::solvers::Jacobian product", halo_.row_size(), columns);
  }
  halo_.bring(x, *sources_);
  action_.apply(sources_->getLocalViewDevice(Tpetra::Access::ReadOnly), product_);
  combine(alpha * alpha_, x.getLocalViewDevice(Tpetra::Access::ReadOnly), -alpha * gamma_, product_, beta,
          y.getLocalViewDevice(Tpetra::Access::ReadWrite));
}

}  // namespace kiln
