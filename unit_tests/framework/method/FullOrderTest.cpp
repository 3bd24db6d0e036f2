#include "framework/method/FullOrder.hpp"

#include <gtest/gtest.h>

#include <Teuchos_DefaultSerialComm.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/Error.hpp"
#include "unit_tests/framework/method/FullOrderCases.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"

namespace kiln {
namespace {

std::shared_ptr<Model> chain(const Teuchos::RCP<const Communicator>& communicator = world()) {
  return std::make_shared<DiffusionChain>(DiffusionChain::Settings{}, communicator);
}

/// u' = −u³ from u = 2 on 5 particles; counts how often its Jacobian is asked for.
class Cubic : public DiffusionChain {
 public:
  Cubic() : DiffusionChain({5, 0.0, 1.0}, world()) {}
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override {
    ++jacobians;
    DiffusionChain::rate_jacobian_diagonal(u, time, diagonal);
  }
  mutable int jacobians = 0;
};

/// u' = 27 − u³ from `start`: the Jacobian at a small u is far too flat for the solution near 3.
class CubicSink : public Model {
 public:
  explicit CubicSink(double start) : start_(start) {}
  Teuchos::RCP<const Map> rows() const override { return map_; }
  Teuchos::RCP<const Map> sources() const override { return map_; }
  std::vector<Field> fields() const override { return {{"mass", "kg"}}; }
  void initial_state(VectorView u) const override { Kokkos::deep_copy(u, start_); }
  void rate(ConstVectorView u, double, VectorView f) const override {
    for (std::size_t i = 0; i < f.extent(0); ++i) f(i) = 27.0 - u(i) * u(i) * u(i);
  }
  void rate_jacobian_diagonal(ConstVectorView u, double, VectorView d) const override {
    for (std::size_t i = 0; i < d.extent(0); ++i) d(i) = -3.0 * u(i) * u(i);
  }

 private:
  Teuchos::RCP<const Map> map_ = Teuchos::rcp(new Map(6, 0, world()));
  double start_;
};

double largest_difference(ConstVectorView a, ConstVectorView b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.extent(0); ++i) largest = std::max(largest, std::abs(a(i) - b(i)));
  return contract::largest_over_ranks(*world(), largest);
}

/// Differences of the rate disturb the matrix by 1e-8; asking more of the linear solve is asking for noise.
double linear_tolerance(JacobianForm form) { return form == JacobianForm::finite_difference ? 1e-6 : 1e-10; }

TEST(FullOrder, EveryJacobianAndLinearSolverReachTheSameState) {
  constexpr double step = 0.05;
  FullOrder reference(chain(), newton(JacobianForm::sparse, 1e-13), krylov("gmres", 1e-12));
  const VectorView expected = run(reference, "trapezoidal", step, 2);
  const auto check = [&](const std::string& name, const NewtonSettings& settings,
                         std::shared_ptr<LinearSolver> solver) {
    FullOrder method(chain(), settings, std::move(solver));
    EXPECT_LT(largest_difference(run(method, "trapezoidal", step, 2), expected), 1e-11) << name;
  };
  check("diagonal", newton(JacobianForm::diagonal, 1e-13, 200), nullptr);
  for (JacobianForm form : {JacobianForm::sparse, JacobianForm::matrix_free, JacobianForm::finite_difference}) {
    for (const char* solver : {"gmres", "cg", "bicgstab"}) {
      for (const char* preconditioner : {"none", "jacobi"}) {
        check(to_text(form) + ", " + solver + ", " + preconditioner, newton(form, 1e-13),
              krylov(solver, linear_tolerance(form), preconditioner));
      }
    }
  }
}

TEST(FullOrder, BetterJacobiansNeedFewerUpdates) {
  const auto updates = [](JacobianForm form) {
    FullOrder method(chain(), newton(form, 1e-10, 100), krylov("gmres", linear_tolerance(form)));
    const auto time_scheme = scheme("backward euler", method, 0.2);
    const VectorView x = initial(method);
    time_scheme->start(x, 0.0);
    const SolveReport report = time_scheme->advance(x, 0.2);
    EXPECT_TRUE(report.converged) << to_text(form);
    EXPECT_LE(report.last_norm, 1e-10 * report.first_norm) << to_text(form);
    EXPECT_EQ(report.residuals, report.iterations + 1) << to_text(form);
    return report.iterations;
  };
  const int sparse = updates(JacobianForm::sparse);
  EXPECT_EQ(updates(JacobianForm::matrix_free), sparse);
  EXPECT_LE(updates(JacobianForm::finite_difference), sparse + 1);
  // Leaving the neighbours out of 1 + 2·5·0.2 multiplies the updates.
  EXPECT_GT(updates(JacobianForm::diagonal), 2 * sparse);
}

TEST(FullOrder, RanksAgree) {
  const Teuchos::RCP<const Communicator> alone = Teuchos::rcp(new Teuchos::SerialComm<int>());
  for (const char* type : {"backward euler", "trapezoidal", "bdf2", "rk4"}) {
    FullOrder apart(chain(), newton(JacobianForm::sparse, 1e-13), krylov("gmres", 1e-12));
    FullOrder whole(chain(alone), newton(JacobianForm::sparse, 1e-13), krylov("gmres", 1e-12));
    const VectorView mine = run(apart, type, 0.02, 4), all = run(whole, type, 0.02, 4);
    for (LocalIndex i = 0; i < local_size(*apart.coordinates()); ++i) {
      EXPECT_NEAR(mine(i), all(apart.coordinates()->getGlobalElement(i)), 1e-12) << type;
    }
    FullOrder ring(std::make_shared<PendulumRing>(11, world()), newton(JacobianForm::finite_difference, 1e-13),
                   krylov("gmres", 1e-6));
    FullOrder ring_alone(std::make_shared<PendulumRing>(11, alone), newton(JacobianForm::finite_difference, 1e-13),
                         krylov("gmres", 1e-6));
    const VectorView part = run(ring, type, 0.02, 4), complete = run(ring_alone, type, 0.02, 4);
    for (LocalIndex i = 0; i < local_size(*ring.coordinates()); ++i) {
      EXPECT_NEAR(part(i), complete(ring.coordinates()->getGlobalElement(i)), 1e-12) << type << ", two components";
    }
  }
}

TEST(FullOrder, TheJacobianIsTakenOncePerRefreshPeriod) {
  for (const auto& [refresh, steps, expected] : {std::array{1, 7, 7}, {3, 7, 3}, {10, 21, 3}, {100, 21, 1}}) {
    const auto model = std::make_shared<Cubic>();
    FullOrder method(model, newton(JacobianForm::diagonal, 1e-8, 100, refresh));
    run(method, "backward euler", 0.05, steps);
    // The scheme asks once whether there is one.
    EXPECT_EQ(model->jacobians, 1 + expected) << "refresh " << refresh << ", " << steps << " steps";
    EXPECT_EQ(method.jacobian_evaluations(), expected);
  }
}

TEST(FullOrder, ANewSchemeFindsNoOldJacobian) {
  for (JacobianForm form : {JacobianForm::diagonal, JacobianForm::sparse}) {
    FullOrder method(chain(), newton(form, 1e-8, 100, 100), krylov("gmres", 1e-10));
    const VectorView first = run(method, "backward euler", 0.05, 4), again = run(method, "backward euler", 0.05, 4);
    EXPECT_EQ(method.jacobian_evaluations(), 2) << to_text(form);
    EXPECT_EQ(largest_difference(first, again), 0.0) << to_text(form);
  }
}

TEST(FullOrder, TheCapEndsAStep) {
  FullOrder method(chain(), newton(JacobianForm::diagonal, 1e-12, 2));
  const auto time_scheme = scheme("backward euler", method, 0.2);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  const SolveReport report = time_scheme->advance(x, 0.2);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_EQ(report.residuals, 3);
  EXPECT_GT(report.last_norm, 1e-12 * report.first_norm);
}

TEST(FullOrder, AStateThatSolvesTheStepTakesNoUpdate) {
  FullOrder method(std::make_shared<CubicSink>(3.0), newton(JacobianForm::diagonal));
  const auto time_scheme = scheme("backward euler", method, 0.1);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  const SolveReport report = time_scheme->advance(x, 0.1);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residuals, 1);
  EXPECT_EQ(method.jacobian_evaluations(), 0);
}

TEST(FullOrder, TheLineSearchSavesAStepThatDiverges) {
  NewtonSettings settings = newton(JacobianForm::diagonal, 1e-10, 100);
  constexpr double step = 10.0;
  FullOrder plain(std::make_shared<CubicSink>(0.1), settings);
  EXPECT_THROW(run(plain, "backward euler", step, 1), DivergenceError);

  settings.line_search = true;
  FullOrder method(std::make_shared<CubicSink>(0.1), settings);
  const auto time_scheme = scheme("backward euler", method, step);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  const SolveReport report = time_scheme->advance(x, step);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.residuals, report.iterations + 1) << "no update was halved";
  for (std::size_t i = 0; i < x.extent(0); ++i) EXPECT_NEAR(x(i) + step * (std::pow(x(i), 3) - 27.0), 0.1, 1e-6);
}

TEST(FullOrder, ALineSearchWithoutDescentEndsTheStep) {
  /// A Jacobian of the wrong sign: every update leads away from the solution.
  class Uphill : public CubicSink {
   public:
    Uphill() : CubicSink(2.0) {}
    void rate_jacobian_diagonal(ConstVectorView, double, VectorView d) const override { Kokkos::deep_copy(d, 30.0); }
  };
  NewtonSettings settings = newton(JacobianForm::diagonal, 1e-10, 100);
  settings.line_search = true;
  FullOrder method(std::make_shared<Uphill>(), settings);
  const auto time_scheme = scheme("backward euler", method, 0.1);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  const SolveReport report = time_scheme->advance(x, 0.1);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.residuals, 2 + NewtonSettings::halvings);
}

TEST(FullOrder, AnExplicitSchemeSolvesNothing) {
  FullOrder method(chain(), newton(JacobianForm::diagonal));
  const auto time_scheme = scheme("explicit euler", method, 0.01);
  const VectorView x = initial(method);
  const VectorView u("kiln::test::u", method.row_size()), f("kiln::test::f", method.row_size());
  method.evaluate(x, 0.0, u, f);
  time_scheme->start(x, 0.0);
  const SolveReport report = time_scheme->advance(x, 0.01);
  EXPECT_EQ(report.residuals, 1);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(method.jacobian_evaluations(), 0);
  for (std::size_t i = 0; i < x.extent(0); ++i) EXPECT_NEAR(x(i), u(i) + 0.01 * f(i), 1e-15 * (1 + std::abs(x(i))));
}

TEST(FullOrder, SolveReturnsStateAndRateAtTheSolution) {
  FullOrder method(std::make_shared<PendulumRing>(11, world()), newton(JacobianForm::finite_difference, 1e-10),
                   krylov("gmres", 1e-6));
  const VectorView x = initial(method), history("kiln::test::h", method.row_size());
  for (std::size_t i = 0; i < x.extent(0); ++i) history(i) = -x(i);
  const VectorView u("kiln::test::u", method.row_size()), f("kiln::test::f", method.row_size());
  const VectorView u2("kiln::test::u2", method.row_size()), f2("kiln::test::f2", method.row_size());
  method.solve({1.0, 0.1, 0.1, history}, x, u, f);
  method.evaluate(x, 0.1, u2, f2);
  for (std::size_t i = 0; i < x.extent(0); ++i) {
    EXPECT_EQ(u(i), x(i));
    EXPECT_EQ(u2(i), x(i));
    EXPECT_EQ(f(i), f2(i)) << "to the bit: a restart evaluates it anew";
    EXPECT_NEAR(x(i) - 0.1 * f(i) + history(i), 0.0, 1e-9);
  }
}

TEST(FullOrder, IsMadeFromTheInput) {
  Teuchos::ParameterList input;
  Teuchos::ParameterList& model = input.sublist("model");
  model.set("type", std::string("test diffusion chain"));
  model.set("particles", 12).set("conduction", 3.0).set("reaction", 0.0);
  Teuchos::ParameterList& list = input.sublist("time").sublist("newton");
  list.set("tolerance", 1e-3).set("iterations", 10).set("jacobian", std::string("matrix free")).set("refresh", 4);
  list.set("line_search", false);
  list.sublist("linear_solver").set("type", std::string("cg")).set("tolerance", 1e-6).set("iterations", 50);
  list.sublist("linear_solver").set("preconditioner", std::string("none"));
  input.sublist("method").set("type", std::string("fom"));
  const auto method = Registry<Method>::create(input.sublist("method"), {input, world()});
  EXPECT_EQ(method->particles()->getGlobalNumElements(), 12u);
  EXPECT_EQ(method->fields()[0].unit, "K");
  EXPECT_EQ(method->parameters().get("conduction"), 3.0);
  run(*method, "backward euler", 0.1, 5);
  nlohmann::json report;
  method->report(report);
  method->report_work(report);
  EXPECT_EQ(report["particles"], 12);
  EXPECT_EQ(report["jacobian"], "matrix free");
  EXPECT_EQ(report["jacobian_evaluations"], 2);
  EXPECT_GT(report["linear_iterations"], 0);

  list.set("jacobian", std::string("diagnal"));
  try {
    NewtonSettings settings(list);
    FAIL() << "an unknown Jacobian was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].suggestion, "diagonal");
  }
}

TEST(FullOrder, PositionsAndStateAreThoseOfTheRows) {
  FullOrder method(chain(), newton(JacobianForm::diagonal));
  const ConstPositionView positions = method.positions();
  ASSERT_EQ(positions.extent(0), std::size_t(local_size(*method.particles())));
  const VectorView x = initial(method), u("kiln::test::u", x.extent(0));
  method.state(x, u);
  for (std::size_t i = 0; i < x.extent(0); ++i) {
    EXPECT_EQ(u(i), x(i));
    EXPECT_EQ(positions(i, 0), 0.5 * method.particles()->getGlobalElement(static_cast<LocalIndex>(i)));
  }
}

TEST(FullOrder, FormsThatAModelLacksAreNamed) {
  const auto ring = std::make_shared<PendulumRing>(11, world());
  for (JacobianForm form : {JacobianForm::diagonal, JacobianForm::sparse, JacobianForm::matrix_free}) {
    FullOrder method(ring, newton(form), krylov("gmres"));
    EXPECT_THROW(method.require_jacobian(), NotOffered) << to_text(form);
    EXPECT_THROW(run(method, "backward euler", 0.1, 1), InputError) << to_text(form);
    EXPECT_NO_THROW(run(method, "rk4", 0.1, 1)) << to_text(form);
  }
  FullOrder method(ring, newton(JacobianForm::finite_difference), krylov("gmres"));
  EXPECT_NO_THROW(method.require_jacobian());
  EXPECT_THROW(FullOrder(chain(), newton(JacobianForm::sparse)), std::invalid_argument);
}

}  // namespace
}  // namespace kiln
