#include "framework/solvers/JacobianAction.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>

#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/framework/model/TestModels.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

/// Three columns of very different sizes, and one of zeros.
MatrixView columns(const Model& model) {
  const MatrixView v("kiln::test::v", contract::source_size(model), 4);
  for (int k = 0; k < 3; ++k) {
    const VectorView column = contract::pattern_over_sources(model, std::pow(1e3, k - 1), k);
    for (std::size_t i = 0; i < column.extent(0); ++i) v(i, k) = column(i);
  }
  return v;
}

/// Largest difference of two products' columns, each relative to its column's largest entry.
double difference(ConstMatrixView a, ConstMatrixView b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.extent(1); ++k) {
    double size = 0.0, off = 0.0;
    for (std::size_t i = 0; i < a.extent(0); ++i) {
      size = std::max(size, std::abs(a(i, k)));
      off = std::max(off, std::abs(a(i, k) - b(i, k)));
    }
    size = contract::largest_over_ranks(*world(), size);
    off = contract::largest_over_ranks(*world(), off);
    largest = std::max(largest, size > 0.0 ? off / size : off);
  }
  return largest;
}

MatrixView product(const Model& model, JacobianForm form, double scale = 1.0) {
  JacobianAction action(model, form);
  const VectorView u = contract::disturbed_state(model);
  for (std::size_t i = 0; i < u.extent(0); ++i) u(i) *= scale;
  action.take(u, 0.2);
  Kokkos::deep_copy(u, std::nan(""));
  const MatrixView result("kiln::test::product", contract::row_size(model), 4);
  action.apply(columns(model), result);
  return result;
}

TEST(JacobianAction, FormsAgree) {
  const DiffusionChain chain({}, world());
  const MatrixView exact = product(chain, JacobianForm::matrix_free);
  EXPECT_EQ(difference(exact, product(chain, JacobianForm::sparse)), 0.0);
  EXPECT_LT(difference(exact, product(chain, JacobianForm::finite_difference)), 1e-6);
  EXPECT_GT(difference(exact, product(chain, JacobianForm::diagonal)), 0.1) << "the diagonal leaves neighbours out";
  for (std::size_t i = 0; i < exact.extent(0); ++i) EXPECT_EQ(exact(i, 3), 0.0);
}

TEST(JacobianAction, AskingForItLeavesWhatWasTaken) {
  const DiffusionChain chain({}, world());
  const VectorView zero("kiln::test::u", contract::source_size(chain));
  for (JacobianForm form : {JacobianForm::diagonal, JacobianForm::matrix_free, JacobianForm::finite_difference}) {
    JacobianAction action(chain, form);
    action.take(contract::disturbed_state(chain), 0.2);
    action.require_offered(zero);
    const MatrixView asked("kiln::test::product", contract::row_size(chain), 4);
    action.apply(columns(chain), asked);
    EXPECT_EQ(difference(product(chain, form), asked), 0.0) << to_text(form);
  }
}

TEST(JacobianAction, TheDifferenceStepFollowsTheStatesScale) {
  // A cubic rate at states of 1e-3 … 1e6 times the usual size: a fixed step would fail at one end.
  const DiffusionChain chain({}, world());
  for (double scale : {1e-3, 1.0, 1e3, 1e6}) {
    const MatrixView exact = product(chain, JacobianForm::matrix_free, scale);
    EXPECT_LT(difference(exact, product(chain, JacobianForm::finite_difference, scale)), 1e-5) << scale;
  }
}

TEST(JacobianAction, AStateOfZerosHasAStepToo) {
  const PendulumRing ring(11, world());
  const MatrixView at_rest = product(ring, JacobianForm::finite_difference, 0.0);
  const MatrixView v = columns(ring);
  for (LocalIndex i = 0; i < local_size(*ring.rows()); ++i) EXPECT_NEAR(at_rest(2 * i, 1), v(2 * i + 1, 1), 1e-7);
}

TEST(JacobianAction, TheDiagonalScalesRows) {
  const DiffusionChain chain({}, world());
  const VectorView u = contract::disturbed_state(chain), diagonal("kiln::test::d", contract::row_size(chain));
  chain.rate_jacobian_diagonal(u, 0.2, diagonal);
  const MatrixView v = columns(chain), scaled = product(chain, JacobianForm::diagonal);
  for (std::size_t i = 0; i < diagonal.extent(0); ++i) EXPECT_EQ(scaled(i, 2), diagonal(i) * v(i, 2));
}

TEST(JacobianAction, CountsItsRates) {
  const DiffusionChain chain({}, world());
  JacobianAction action(chain, JacobianForm::finite_difference);
  const MatrixView result("kiln::test::product", contract::row_size(chain), 4);
  EXPECT_THROW(action.apply(columns(chain), result), std::logic_error);
  action.take(contract::disturbed_state(chain), 0.2);
  action.apply(columns(chain), result);
  EXPECT_EQ(action.rate_evaluations(), 4) << "one at the state, three for columns that are not zero";
}

}  // namespace
}  // namespace kiln
