#include <gtest/gtest.h>

#include <Sacado.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <complex>
#include <random>

#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

constexpr double time = 2e-4;

/// Off the nodes of the material's table, where slopes jump, and off the melting point.
VectorView smooth_state(const Model& model) {
  VectorView u = rough_state(model);
  for (std::size_t i = 0; i < u.extent(0); ++i) {
    u(i) = std::floor(u(i)) + 0.35 + 0.3 * (u(i) - std::floor(u(i)));
    if (std::floor(u(i)) == 1660.0) u(i) += 2.0;
  }
  return u;
}

MatrixView random_columns(const Model& model, int columns) {
  MatrixView v("v", model.sources()->getNodeNumElements(), columns);
  for (std::size_t i = 0; i < v.extent(0); ++i) {
    std::mt19937 generator(static_cast<unsigned>(model.sources()->getGlobalElement(static_cast<LocalIndex>(i))));
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int c = 0; c < columns; ++c) v(i, c) = unit(generator);
  }
  return v;
}

VectorView column_of(const MatrixView& matrix, std::size_t column) {
  VectorView result("column", matrix.extent(0));
  for (std::size_t i = 0; i < matrix.extent(0); ++i) result(i) = matrix(i, column);
  return result;
}

/// Largest difference relative to the largest expected value, over all ranks.
double difference(const VectorView& found, const VectorView& expected) {
  double local[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < found.extent(0); ++i) {
    local[0] = std::max(local[0], std::abs(found(i) - expected(i)));
    local[1] = std::max(local[1], std::abs(expected(i)));
  }
  double largest[2];
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_MAX, 2, local, largest);
  return largest[0] / largest[1];
}

/// f at complex temperatures, through the code that rate() runs.
std::vector<std::complex<double>> complex_rate(const HeatModel& model, const std::vector<std::complex<double>>& u) {
  const HeatDomain& domain = model.domain();
  std::vector<ThermalState<std::complex<double>>> states;
  for (std::size_t j = 0; j < u.size(); ++j) {
    states.push_back(thermal_state(model.material(), u[j], domain.masses(j)));
  }
  const auto source = Registry<HeatSource>::create(HeatCase().heat_source, {});
  VectorView q("q", u.size());
  source->flux(time, domain.positions, q);
  std::vector<std::complex<double>> f;
  for (std::size_t i = 0; i < domain.areas.extent(0); ++i) {
    const std::size_t first = domain.pairs.offsets(i);
    const auto sum = pair_sum(states.data(), states[i], &domain.pairs.neighbours(first), &domain.weights(first),
                              static_cast<LocalIndex>(domain.pairs.offsets(i + 1) - first));
    f.push_back(heat_rate(states[i], sum, domain.masses(i), q(i) * domain.areas(i)));
  }
  return f;
}

TEST(HeatJacobian, ActionIsTheDirectionalDerivative) {
  const auto model = HeatCase().model();
  const VectorView u = smooth_state(*model);
  const MatrixView v = random_columns(*model, 1);
  MatrixView product("product", model->rows()->getNodeNumElements(), 1);
  model->apply_rate_jacobian(u, time, v, product);
  const double step = 1e-4;
  VectorView up("up", u.extent(0));
  VectorView down("down", u.extent(0));
  for (std::size_t i = 0; i < u.extent(0); ++i) {
    up(i) = u(i) + step * v(i, 0);
    down(i) = u(i) - step * v(i, 0);
  }
  VectorView expected = rate_of(*model, up, time);
  const VectorView other = rate_of(*model, down, time);
  for (std::size_t i = 0; i < expected.extent(0); ++i) expected(i) = (expected(i) - other(i)) / (2.0 * step);
  EXPECT_LT(difference(column_of(product, 0), expected), 1e-7);
}

TEST(HeatJacobian, ActionIsTheComplexStep) {
  const auto model = HeatCase().model();
  const VectorView u = smooth_state(*model);
  const MatrixView v = random_columns(*model, 13);
  MatrixView product("product", model->rows()->getNodeNumElements(), 13);
  model->apply_rate_jacobian(u, time, v, product);
  for (const int column : {0, 7, 8, 12}) {
    std::vector<std::complex<double>> stepped;
    for (std::size_t i = 0; i < u.extent(0); ++i) stepped.emplace_back(u(i), 1e-40 * v(i, column));
    const std::vector<std::complex<double>> f = complex_rate(*model, stepped);
    VectorView expected("expected", f.size());
    for (std::size_t i = 0; i < f.size(); ++i) expected(i) = f[i].imag() * 1e40;
    EXPECT_LT(difference(column_of(product, column), expected), 1e-12) << "column " << column;
  }
}

TEST(HeatJacobian, ComplexRateIsTheRate) {
  const auto model = HeatCase().model();
  const VectorView u = smooth_state(*model);
  const auto f = complex_rate(*model, std::vector<std::complex<double>>(u.data(), u.data() + u.extent(0)));
  VectorView expected("expected", f.size());
  for (std::size_t i = 0; i < f.size(); ++i) expected(i) = f[i].real();
  EXPECT_LT(difference(rate_of(*model, u, time), expected), 1e-13);
}

TEST(HeatJacobian, MatrixHasTheEntriesOfAutomaticDifferentiation) {
  using Fad = Sacado::Fad::SLFad<double, 160>;
  const auto model = HeatCase().model();
  const VectorView u = smooth_state(*model);
  model->rate_jacobian_matrix(rough_state(*model), 0.0);
  const auto matrix = model->rate_jacobian_matrix(u, time);
  EXPECT_TRUE(matrix->isFillComplete());
  EXPECT_TRUE(matrix->getDomainMap()->isSameAs(*model->rows()));
  const auto local = matrix->getLocalMatrixHost();
  const HeatDomain& domain = model->domain();
  const auto source = Registry<HeatSource>::create(HeatCase().heat_source, {});
  VectorView q("q", u.extent(0));
  source->flux(time, domain.positions, q);
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(domain.areas.extent(0)); i += 11) {
    const std::size_t first = domain.pairs.offsets(i);
    const auto pairs = static_cast<LocalIndex>(domain.pairs.offsets(i + 1) - first);
    // The row's particle is variable 0, its neighbours the next ones; states of others are not read.
    std::vector<ThermalState<Fad>> states(u.extent(0));
    states[i] = thermal_state(model->material(), Fad(pairs + 1, 0, u(i)), domain.masses(i));
    for (LocalIndex pair = 0; pair < pairs; ++pair) {
      const LocalIndex j = domain.pairs.neighbours(first + pair);
      states[j] = thermal_state(model->material(), Fad(pairs + 1, pair + 1, u(j)), domain.masses(j));
    }
    const Fad sum = pair_sum(states.data(), states[i], &domain.pairs.neighbours(first), &domain.weights(first), pairs);
    const Fad f = heat_rate(states[i], sum, domain.masses(i), q(i) * domain.areas(i));
    const auto row = local.rowConst(i);
    ASSERT_EQ(row.length, pairs + 1);
    const double scale = std::abs(f.dx(0));
    for (LocalIndex entry = 0; entry < row.length; ++entry) {
      if (entry > 0) {
        ASSERT_LT(row.colidx(entry - 1), row.colidx(entry));
      }
      int variable = 0;
      for (LocalIndex pair = 0; pair < pairs; ++pair) {
        if (domain.pairs.neighbours(first + pair) == row.colidx(entry)) variable = pair + 1;
      }
      ASSERT_NEAR(row.value(entry), f.dx(variable), 1e-12 * scale) << "row " << i << ", column " << row.colidx(entry);
    }
  }
}

TEST(HeatJacobian, MatrixTimesVectorIsTheAction) {
  const auto model = HeatCase().model();
  const VectorView u = smooth_state(*model);
  const MatrixView v = random_columns(*model, 1);
  MatrixView product("product", model->rows()->getNodeNumElements(), 1);
  model->apply_rate_jacobian(u, time, v, product);
  Vector x(model->rows());
  Vector y(model->rows());
  for (std::size_t i = 0; i < model->rows()->getNodeNumElements(); ++i) {
    x.replaceLocalValue(static_cast<LocalIndex>(i), v(i, 0));
  }
  model->rate_jacobian_matrix(u, time)->apply(x, y);
  VectorView found("found", product.extent(0));
  const auto values = y.getData();
  for (std::size_t i = 0; i < found.extent(0); ++i) found(i) = values[i];
  EXPECT_LT(difference(found, column_of(product, 0)), 1e-13);
}

TEST(HeatJacobian, DiagonalLeavesMaterialDerivativesOut) {
  // With constant properties nothing is left out.
  HeatCase constant;
  constant.material = HeatCase::constant_material(20.0, 500.0, 8000.0);
  const auto model = constant.model();
  const VectorView u = smooth_state(*model);
  VectorView diagonal("diagonal", model->rows()->getNodeNumElements());
  model->rate_jacobian_diagonal(u, time, diagonal);
  VectorView of_matrix("of matrix", diagonal.extent(0));
  const auto matrix = model->rate_jacobian_matrix(u, time);
  const auto local = matrix->getLocalMatrixHost();
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(diagonal.extent(0)); ++i) {
    const auto row = local.rowConst(i);
    for (LocalIndex entry = 0; entry < row.length; ++entry) {
      if (row.colidx(entry) == i) of_matrix(i) = row.value(entry);
    }
  }
  EXPECT_LT(difference(diagonal, of_matrix), 1e-13);
}

TEST(HeatJacobian, DiagonalIsThatOfFrozenProperties) {
  const auto model = HeatCase().model();
  const HeatDomain& domain = model->domain();
  const VectorView u = smooth_state(*model);
  VectorView diagonal("diagonal", model->rows()->getNodeNumElements());
  model->rate_jacobian_diagonal(u, time, diagonal);
  VectorView expected("expected", diagonal.extent(0));
  for (std::size_t i = 0; i < expected.extent(0); ++i) {
    const MaterialPoint<double> own = model->material().at(u(i));
    double sum = 0.0;
    for (std::size_t pair = domain.pairs.offsets(i); pair < domain.pairs.offsets(i + 1); ++pair) {
      const LocalIndex j = domain.pairs.neighbours(pair);
      const MaterialPoint<double> other = model->material().at(u(j));
      sum += domain.masses(j) / other.density * 4.0 * own.conductivity * other.conductivity /
             (own.conductivity + other.conductivity) * domain.weights(pair);
    }
    expected(i) = sum / (own.density * own.specific_heat);
  }
  EXPECT_LT(difference(diagonal, expected), 1e-13);
}

}  // namespace
}  // namespace kiln
