#include "framework/base/Pi.hpp"
#include "physics/vortex/VortexModel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit_tests/framework/method/FullOrderCases.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

using Names = std::vector<std::string>;

VortexCase with_kernel(const std::string& kernel) {
  VortexCase vortex_case;
  vortex_case.kernel = kernel;
  return vortex_case;
}

const Names kernels{"rosenhead-moore", "lamb-oseen"};
const std::vector<GlobalIndex> some_rows{170, 3, 44, 201, 0, 99, 98};

TEST(VortexModel, HoldsTheContractOfModels) {
  for (const std::string& kernel : kernels) {
    const auto model = with_kernel(kernel).model();
    ASSERT_GT(model->rows()->getGlobalNumElements(), 201u);
    contract::check_sampled(*model, some_rows);
    contract::check_rate_has_no_memory(*model);
    const VectorView u = contract::disturbed_state(*model);
    EXPECT_EQ(contract::check_jacobian_against_finite_differences(*model, u, 0.0), (Names{"action", "diagonal"}));
    EXPECT_EQ(contract::check_parameters(*model), (Names{"kernel.core_radius", "circulation_scale"}));
    EXPECT_THROW(model->rate_jacobian_matrix(u, 0.0), NotOffered);
  }
}

TEST(VortexModel, RateIsThePlainSumOnAnyNumberOfRanks) {
  const auto model = VortexCase().model();
  const VortexCloud cloud = VortexCase().cloud();
  const std::vector<double> found = gathered(*model->rows(), rate_of(*model, initial_state_of(*model)));
  ASSERT_EQ(found.size(), 2 * cloud.x.size());
  double largest = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    double u = 0.0, v = 0.0;
    for (std::size_t j = 0; j < cloud.x.size(); ++j) {
      const double dx = cloud.x[i] - cloud.x[j], dy = cloud.y[i] - cloud.y[j];
      const double weight = cloud.circulation[j] / (2.0 * pi * (dx * dx + dy * dy + 0.04));
      u -= weight * dy;
      v += weight * dx;
    }
    largest = std::max({largest, std::abs(u), std::abs(v)});
    difference = std::max({difference, std::abs(found[2 * i] - u), std::abs(found[2 * i + 1] - v)});
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(difference, 1e-13 * largest);
}

TEST(VortexModel, RateDoesNotDependOnTheNumberOfRanks) {
  for (const std::string& kernel : kernels) {
    const auto together = with_kernel(kernel).model(), single = with_kernel(kernel).model(alone());
    const std::vector<double> found = gathered(*together->rows(), rate_of(*together, initial_state_of(*together)));
    const std::vector<double> expected = gathered(*single->rows(), rate_of(*single, initial_state_of(*single)));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-15) << kernel;
  }
}

TEST(VortexModel, JacobianActsOnSeveralColumnsAsOnEach) {
  const auto model = VortexCase().model();
  const VectorView u = contract::disturbed_state(*model);
  constexpr int columns = 7;
  const std::size_t sources = contract::source_size(*model), rows = contract::row_size(*model);
  const MatrixView v("v", sources, columns), product("product", rows, columns);
  for (int c = 0; c < columns; ++c) {
    Kokkos::deep_copy(Kokkos::subview(v, Kokkos::ALL, c), contract::pattern_over_sources(*model, 1.0, c));
  }
  model->apply_rate_jacobian(u, 0.0, v, product);
  for (int c = 0; c < columns; ++c) {
    const MatrixView one("one", rows, 1);
    model->apply_rate_jacobian(u, 0.0, ConstMatrixView(&v(0, c), sources, 1), one);
    for (std::size_t i = 0; i < rows; ++i) {
      EXPECT_NEAR(product(i, c), one(i, 0), 1e-12 * (1.0 + std::abs(one(i, 0)))) << "column " << c;
    }
  }
}

TEST(VortexModel, JacobianOfAShiftVanishes) {
  const auto model = with_kernel("lamb-oseen").model();
  const std::size_t sources = contract::source_size(*model), rows = contract::row_size(*model);
  const MatrixView v("v", sources, 1), product("product", rows, 1);
  for (std::size_t i = 0; i < sources; ++i) v(i, 0) = i % 2 == 0 ? 3.0 : -1.0;
  model->apply_rate_jacobian(initial_state_of(*model), 0.0, v, product);
  for (std::size_t i = 0; i < rows; ++i) EXPECT_EQ(product(i, 0), 0.0);
}

/// Angle by which a pair's vortices have turned about their centre of circulation, and how far they are apart, after
/// one step count of RK4; both from the places of all particles.
struct Turned {
  double angle;
  double separation;
};

Turned after_a_turn(const VortexCase& vortex_case, double time, int steps) {
  FullOrder method(std::shared_ptr<Model>(vortex_case.model()), newton(JacobianForm::diagonal));
  const VectorView x = run(method, "rk4", time / steps, steps);
  const std::vector<double> places = gathered(*method.particles(), x);
  const double dx = places[2] - places[0], dy = places[3] - places[1];
  return {std::atan2(dy, dx), std::hypot(dx, dy)};
}

TEST(VortexPair, TurnsAtTheRegularisedAngularVelocity) {
  constexpr double separation = 1.3, core = 0.7, left = 2.0, right = 0.9;
  for (const std::string& kernel : kernels) {
    VortexCase vortex_case = with_kernel(kernel);
    vortex_case.core_radius = core;
    vortex_case.particles = VortexCase::pair(left, right, separation);
    const double d2 = separation * separation;
    const double q = kernel == "lamb-oseen" ? (1.0 - std::exp(-d2 / (core * core))) / d2 : 1.0 / (d2 + core * core);
    const double angular_velocity = (left + right) / (2.0 * pi) * q;
    const double period = 2.0 * pi / angular_velocity;
    for (const double part : {0.2, 1.0}) {
      const Turned turned = after_a_turn(vortex_case, part * period, 400);
      const double expected = part < 1.0 ? 2.0 * pi * part : 0.0;
      EXPECT_NEAR(turned.angle, expected, 2e-8) << kernel;
      EXPECT_NEAR(turned.separation, separation, 2e-8) << kernel;
    }
    // A negative control: with the point vortices' angular velocity the angle would be off by far more.
    EXPECT_GT(std::abs(angular_velocity - (left + right) / (2.0 * pi * d2)), 1e-2 * angular_velocity);
  }
}

TEST(VortexPair, OfOppositeCirculationsMovesStraightOn) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::pair(1.0, -1.0, 0.8);
  FullOrder method(std::shared_ptr<Model>(vortex_case.model()), newton(JacobianForm::diagonal));
  const std::vector<double> places = gathered(*method.particles(), run(method, "rk4", 0.1, 30));
  const double speed = 0.8 / (2.0 * pi * (0.64 + 0.04));
  EXPECT_NEAR(places[0], -0.4, 1e-14);
  EXPECT_NEAR(places[2], 0.4, 1e-14);
  EXPECT_NEAR(places[1], 3.0 * speed, 1e-12);
  EXPECT_NEAR(places[3], 3.0 * speed, 1e-12);
}

TEST(VortexPair, CirculationScaleIsAFactorOnTime) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::pair(1.0, 0.5, 1.0);
  const auto positions_after = [&](double scale, double step) {
    auto model = std::shared_ptr<Model>(vortex_case.model());
    model->parameters().set("circulation_scale", scale);
    FullOrder method(model, newton(JacobianForm::diagonal));
    return gathered(*method.particles(), run(method, "rk4", step, 50));
  };
  const std::vector<double> slow = positions_after(1.0, 0.1), fast = positions_after(2.0, 0.05);
  for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(slow[i], fast[i], 1e-14);
}

TEST(VortexModel, ImplicitStepsWithEitherJacobianAgree) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::two_patches(0.4);
  const auto places_with = [&](JacobianForm form) {
    FullOrder method(std::shared_ptr<Model>(vortex_case.model()), newton(form, 1e-12), krylov("gmres"));
    return gathered(*method.particles(), run(method, "trapezoidal", 0.1, 10));
  };
  const std::vector<double> diagonal = places_with(JacobianForm::diagonal);
  const std::vector<double> matrix_free = places_with(JacobianForm::matrix_free);
  for (std::size_t i = 0; i < diagonal.size(); ++i) EXPECT_NEAR(diagonal[i], matrix_free[i], 1e-10);
}

}  // namespace
}  // namespace kiln
