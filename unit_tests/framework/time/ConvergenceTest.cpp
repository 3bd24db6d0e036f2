#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <cmath>
#include <cstdio>
#include <functional>

#include "framework/time/LinearMultistep.hpp"
#include "unit_tests/framework/method/FullOrderCases.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"

namespace kiln {
namespace {

/// Error of u' = −2 t u², u(0) = 1 at t = 1, after `steps` steps.
double error_after(int steps, const std::function<std::unique_ptr<TimeScheme>(Method&, double)>& make) {
  const auto model = std::make_shared<RationalDecay>(world());
  FullOrder method(model, newton(JacobianForm::diagonal, 1e-14));
  const double step = 1.0 / steps;
  const auto time_scheme = make(method, step);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  advance(*time_scheme, x, step, 0, steps);
  const double error = x.extent(0) > 0 ? std::abs(x(0) - model->solution(1.0)) : 0.0;
  return contract::largest_over_ranks(*world(), error);
}

/// Observed order from halving the step of `steps` steps; printed, so that a reader sees what was measured.
void expect_order(const std::string& name, double expected, int steps,
                  const std::function<std::unique_ptr<TimeScheme>(Method&, double)>& make) {
  const double coarse = error_after(steps, make), fine = error_after(2 * steps, make);
  const double order = std::log2(coarse / fine);
  if (world()->getRank() == 0) {
    std::printf("%-28s errors %.3e, %.3e: order %.3f (expected %.0f)\n", name.c_str(), coarse, fine, order, expected);
  }
  EXPECT_NEAR(order, expected, 0.1) << name;
}

TEST(Convergence, RegisteredSchemesHaveTheirOrders) {
  for (const auto& [name, order] : {std::pair<const char*, double>{"backward euler", 1},
                                    {"explicit euler", 1},
                                    {"trapezoidal", 2},
                                    {"bdf2", 2},
                                    {"heun", 2},
                                    {"ssp rk3", 3},
                                    {"rk4", 4}}) {
    const std::string type = name;
    expect_order(type, order, 80, [&](Method& method, double step) { return scheme(type, method, step); });
  }
}

/// The scheme `linear multistep` with coefficients from a checked block.
std::unique_ptr<TimeScheme> any_multistep(std::vector<double> alpha, std::vector<double> beta, Method& method,
                                          double step) {
  Teuchos::ParameterList list("time.scheme");
  list.set("type", std::string("linear multistep"));
  list.set("alpha", Teuchos::Array<double>(alpha));
  list.set("beta", Teuchos::Array<double>(beta));
  return Registry<TimeScheme>::create(list, {method, step});
}

TEST(Convergence, ChosenCoefficientsHaveTheirOrdersStartIncluded) {
  struct Case {
    const char* name;
    double order;
    std::vector<double> alpha, beta;
  };
  const std::vector<Case> cases{
      {"Adams-Bashforth 2", 2, {1, -1, 0}, {0, 1.5, -0.5}},
      {"Adams-Bashforth 3", 3, {1, -1, 0, 0}, {0, 23.0 / 12, -16.0 / 12, 5.0 / 12}},
      {"BDF3, trapezoidal start", 3, {11.0 / 6, -3, 1.5, -1.0 / 3}, {1, 0, 0, 0}},
      {"Adams-Moulton 4, rk4 start", 4, {1, -1, 0, 0}, {9.0 / 24, 19.0 / 24, -5.0 / 24, 1.0 / 24}},
      {"leapfrog", 2, {1, 0, -1}, {0, 2, 0}}};
  for (const Case& c : cases) {
    expect_order(c.name, c.order, 80,
                 [&](Method& method, double step) { return any_multistep(c.alpha, c.beta, method, step); });
  }
}

TEST(Convergence, CoefficientsOfBackwardEulerAreBackwardEuler) {
  FullOrder method(std::make_shared<RationalDecay>(world()), newton(JacobianForm::diagonal, 1e-14));
  const VectorView a = run(method, "backward euler", 0.1, 10), b = initial(method);
  const auto same = any_multistep({1, -1}, {1, 0}, method, 0.1);
  same->start(b, 0.0);
  advance(*same, b, 0.1, 0, 10);
  for (std::size_t i = 0; i < a.extent(0); ++i) EXPECT_EQ(a(i), b(i));
}

TEST(Convergence, InconsistentCoefficientsAreRefusedByName) {
  FullOrder method(std::make_shared<RationalDecay>(world()), newton(JacobianForm::diagonal));
  try {
    any_multistep({1, -0.9}, {1}, method, 0.1);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].path, "time.scheme.beta");
  }
}

TEST(Convergence, AnAdvanceWithoutStartIsRefused) {
  FullOrder method(std::make_shared<RationalDecay>(world()), newton(JacobianForm::diagonal));
  const VectorView x = initial(method);
  EXPECT_THROW(scheme("bdf2", method, 0.1)->advance(x, 0.1), std::logic_error);
}

}  // namespace
}  // namespace kiln
