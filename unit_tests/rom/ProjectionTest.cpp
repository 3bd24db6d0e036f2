#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "Projections.hpp"
#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/model/MaskedModel.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

using test::Case;
using test::largest_difference;
using test::march;
using test::model_of;
using test::projection;
using test::self;
using test::world;

std::unique_ptr<PetrovGalerkin> of_kind(const std::string& kind, const Case& values, int modes,
                                        const std::shared_ptr<Model>& model) {
  if (kind == "galerkin") return projection(model, values, modes, test::galerkin_test);
  if (kind == "lspg") return projection(model, values, modes, test::lspg_test);
  return test::gnat_projection(model, values, modes, values.count * values.components);
}

std::unique_ptr<PetrovGalerkin> of_kind(const std::string& kind, const Case& values, int modes,
                                        const Teuchos::RCP<const Communicator>& communicator) {
  return of_kind(kind, values, modes, model_of(values, communicator));
}

struct MethodAndScheme {
  const char* method;
  const char* scheme;
  int components;
};
void PrintTo(const MethodAndScheme& p, std::ostream* out) {
  *out << p.method << ", " << p.scheme << ", " << p.components << " components";
}

class FullRank : public testing::TestWithParam<MethodAndScheme> {};

TEST_P(FullRank, ReproducesTheFullOrderRun) {
  Case values;
  values.count = 30;
  values.steps = 25;
  values.scheme = GetParam().scheme;
  values.components = GetParam().components;
  FullOrder full(
      model_of(values, world()), newton_of(values),
      Registry<LinearSolver>::create(input_of(values).sublist("time").sublist("newton").sublist("linear_solver"), {}));
  const std::vector<double> exact = march(full, values);
  const auto reduced = of_kind(GetParam().method, values, values.count * values.components, world());
  EXPECT_LT(largest_difference(march(*reduced, values), exact), 1e-9);
  // The run does something: the states it reproduces are far from the initial ones.
  VectorView zero("zero", values.count * values.components);
  EXPECT_GT(largest_difference(test::gathered_state(*reduced, zero), exact), 0.1);
}

std::vector<MethodAndScheme> all_pairs() {
  std::vector<MethodAndScheme> pairs;
  for (const char* method : {"galerkin", "lspg", "gnat"}) {
    for (const char* scheme : {"backward euler", "trapezoidal", "bdf2", "explicit euler", "rk4"}) {
      for (const int components : {1, 2}) pairs.push_back({method, scheme, components});
    }
  }
  return pairs;
}

INSTANTIATE_TEST_SUITE_P(Projection, FullRank, testing::ValuesIn(all_pairs()));

class Projection : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, Projection, testing::Values("galerkin", "lspg", "gnat"));

TEST_P(Projection, IsTheSameOnAnyNumberOfRanks) {
  Case values;
  values.components = 2;
  const auto together = of_kind(GetParam(), values, 8, world());
  const auto alone = of_kind(GetParam(), values, 8, self());
  EXPECT_LT(largest_difference(march(*together, values), march(*alone, values)), 1e-10);
}

TEST_P(Projection, TakesMoreThan128Modes) {
  Case values;
  values.count = 200;
  values.steps = 2;
  const auto together = of_kind(GetParam(), values, 150, world());
  const auto alone = of_kind(GetParam(), values, 150, self());
  EXPECT_LT(largest_difference(march(*together, values), march(*alone, values)), 1e-10);
}

TEST_P(Projection, ReachesTheSameStateWithEveryJacobian) {
  Case values;
  values.steps = 10;
  const std::vector<double> exact = march(*of_kind(GetParam(), values, 8, world()), values);
  for (const char* form : {"sparse", "finite difference"}) {
    values.jacobian = form;
    // LSPG's and GNAT's answers depend on the test space; a differenced Jacobian changes it by its own error.
    EXPECT_LT(largest_difference(march(*of_kind(GetParam(), values, 8, world()), values), exact), 1e-6) << form;
  }
}

/// Counts steps that ended unsolved.
struct Unsolved : StepListener {
  int steps = 0;
  void observe(const Moment& moment) override { steps += moment.solve.converged ? 0 : 1; }
};

TEST_P(Projection, AStepIsSolvedWhereOnlyRoundOffIsLeft) {
  Case values;
  values.tolerance = 1e-17;
  values.power = 0.0;  // towards a steady state, where a step's first residual is round-off itself
  values.steps = 200;
  Unsolved unsolved;
  march(*of_kind(GetParam(), values, 8, world()), values, {&unsolved});
  EXPECT_EQ(unsolved.steps, 0);
}

TEST_P(Projection, KeepsItsJacobianForTheStepsAskedFor) {
  Case values;
  values.steps = 20;
  values.refresh = 7;
  const auto method = of_kind(GetParam(), values, 8, world());
  march(*method, values);
  nlohmann::json section;
  method->report(section);
  method->report_work(section);
  EXPECT_EQ(section["linearisations"], 3);
  EXPECT_EQ(section["basis_rank"], 8);
}

TEST_P(Projection, RestartsBitByBit) {
  Case values;
  values.steps = 23;
  values.refresh = 5;
  values.tolerance = 1e-6;
  const auto scheme_of = [&values](Method& method) {
    return Registry<TimeScheme>::create(input_of(values).sublist("time").sublist("scheme"),
                                        TimeScheme::Context{method, values.step});
  };
  for (const char* name : {"backward euler", "bdf2"}) {
    values.scheme = name;
    const auto whole = of_kind(GetParam(), values, 8, world());
    VectorView x("x", 8);
    auto scheme = scheme_of(*whole);
    whole->initial(x);
    scheme->start(x, 0.0);
    run_time_loop(*whole, *scheme, x, {values.step, 0, 12}, {});
    const std::string file = std::string("restart_") + GetParam() + std::to_string(world()->getSize()) + ".h5";
    VectorView kept("kept", 8);
    Kokkos::deep_copy(kept, x);
    {
      hdf5::File out = hdf5::File::create(file, world());
      hdf5::Group method_group = out.create_group("method"), scheme_group = out.create_group("scheme");
      whole->save(method_group);
      scheme->save(scheme_group);
    }
    run_time_loop(*whole, *scheme, x, {values.step, 12, 23}, {});

    const auto again = of_kind(GetParam(), values, 8, world());
    auto restarted = scheme_of(*again);
    {
      const hdf5::File in = hdf5::File::read(file, world());
      again->restore(in.group("method"));
      restarted->restore(in.group("scheme"));
    }
    run_time_loop(*again, *restarted, kept, {values.step, 12, 23}, {});
    for (int k = 0; k < 8; ++k) EXPECT_EQ(kept(k), x(k)) << name << ", coordinate " << k;
    world()->barrier();
    if (world()->getRank() == 0) std::filesystem::remove(file);
  }
}

TEST_P(Projection, NamesTheParticleWhereItDiverges) {
  Case values;
  const auto method = of_kind(GetParam(), values, 8, world());
  method->parameters().set("power", 1e308);
  method->parameters().set("velocity", 0.0);
  try {
    march(*method, values);
    FAIL() << "nothing was thrown";
  } catch (const DivergenceError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("step 1, t = 0.002 s, particle ", 0), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find(" m: "), std::string::npos) << error.what();
  }
}

TEST_P(Projection, CountsWhatAStepTakes) {
  Case values;
  values.tolerance = 1e-10;
  values.iterations = 1;
  const auto method = of_kind(GetParam(), values, 8, world());
  VectorView x("x", 8), history("h", method->row_size()), u("u", method->row_size()), f("f", method->row_size());
  method->evaluate(x, 0.0, u, f);
  for (std::size_t i = 0; i < u.extent(0); ++i) history(i) = -u(i);
  const StepResidual step{1.0, values.step, values.step, history};
  int seen = 0;
  method->observe_residuals([&seen](ConstVectorView) { ++seen; });
  const SolveReport capped = method->solve(step, x, u, f);
  EXPECT_EQ(capped.iterations, 1);
  EXPECT_EQ(capped.residuals, 2);
  EXPECT_EQ(seen, 2);
  EXPECT_FALSE(capped.converged);
  EXPECT_LT(capped.last_norm, 1e-2 * capped.first_norm);
  // u and f belong to the accepted x.
  VectorView u_again("u", u.extent(0)), f_again("f", f.extent(0));
  method->evaluate(x, step.time, u_again, f_again);
  for (std::size_t i = 0; i < u.extent(0); ++i) {
    EXPECT_EQ(u(i), u_again(i));
    EXPECT_EQ(f(i), f_again(i));
  }
}

/// ‖r‖ over all rows after one step of a method.
double residual_norm_after_step(PetrovGalerkin& method, const Case& values) {
  VectorView x("x", 4), history("h", method.row_size()), u("u", method.row_size()), f("f", method.row_size());
  method.evaluate(x, 0.0, u, f);
  for (std::size_t i = 0; i < u.extent(0); ++i) history(i) = -u(i);
  // The minimum of ‖r‖ is where the Jacobian's own step stays: each solve takes the Jacobian anew.
  for (int k = 0; k < 20; ++k) method.solve({1.0, values.step, values.step, history}, x, u, f);
  double sum = 0.0;
  for (std::size_t i = 0; i < u.extent(0); ++i) sum += std::pow(u(i) - values.step * f(i) + history(i), 2);
  sum_over_ranks(*world(), &sum, 1);
  return std::sqrt(sum);
}

TEST(Lspg, MinimisesTheResidualThatGalerkinDoesNot) {
  Case values;
  values.step = 0.1;
  // Both numbers were computed independently with NumPy: Newton on the two stationarity conditions to round-off.
  EXPECT_NEAR(residual_norm_after_step(*of_kind("lspg", values, 4, world()), values), 5.432849245104782, 1e-9);
  EXPECT_NEAR(residual_norm_after_step(*of_kind("galerkin", values, 4, world()), values), 5.57253370687072, 1e-9);
}

TEST(Gnat, WithAllRowsAndACompleteResidualBasisIsLspg) {
  Case values;
  const auto gnat = of_kind("gnat", values, 8, world());
  const auto lspg = of_kind("lspg", values, 8, world());
  EXPECT_LT(largest_difference(march(*gnat, values), march(*lspg, values)), 1e-11);
}

TEST(Gnat, OnAMaskedModelIsGnatOnASampledOne) {
  for (const int components : {1, 2}) {
    Case values;
    values.components = components;
    const std::shared_ptr<Model> full = model_of(values, world());
    std::vector<GlobalIndex> rows;
    for (int id = 1; id < values.count; id += 3) rows.push_back(id);
    const std::shared_ptr<Model> sampled = full->sampled(rows);
    const auto masked = std::make_shared<MaskedModel>(full, rows);
    const auto a = test::gnat_projection(sampled, values, 8, 12);
    const auto b = test::gnat_projection(masked, values, 8, 12);
    EXPECT_LT(largest_difference(march(*a, values), march(*b, values)), 1e-12);
  }
}

TEST(Gnat, OnASampleMeshIsCloseToLspg) {
  Case values;
  const std::shared_ptr<Model> full = model_of(values, world());
  std::vector<GlobalIndex> rows;
  for (int id = 0; id < values.count; id += 2) rows.push_back(id);
  const auto gnat = test::gnat_projection(full->sampled(rows), values, 8, 16);
  const auto lspg = of_kind("lspg", values, 8, world());
  const std::vector<double> sampled = march(*gnat, values), all = march(*lspg, values);
  double difference = 0.0;
  for (const GlobalIndex id : rows) difference = std::max(difference, std::abs(sampled[id] - all[id]));
  EXPECT_LT(difference, 0.2);
  EXPECT_GT(difference, 1e-8);  // hyper-reduction is an approximation; exactly LSPG would mean that it did not happen
}

TEST(PetrovGalerkin, StartsFromTheNearestStateWhereTheReferenceIsAnother) {
  Case values;
  const std::shared_ptr<Model> model = model_of(values, world());
  const VectorView zero("zero", local_size(*model->sources()));
  PetrovGalerkin::Parts parts =
      full_size_parts(model, {{1.0, 0, values.count}}, zero,
                      test::cosines(*model->sources(), 1, values.count, values.count), test::galerkin_test);
  PetrovGalerkin method(std::move(parts), newton_of(values));
  VectorView x("x", values.count), u("u", method.row_size()), initial("u0", local_size(*model->sources()));
  method.initial(x);
  method.state(x, u);
  model->initial_state(initial);
  for (LocalIndex i = 0; i < method.row_size(); ++i) EXPECT_NEAR(u(i), initial(i), 1e-13);
}

TEST(PetrovGalerkin, NewFactorsInEveryIterationChangeNothing) {
  Case values;
  values.steps = 10;
  values.refresh = 3;
  const std::vector<double> kept = march(*of_kind("lspg", values, 8, world()), values);
  const std::shared_ptr<Model> model = model_of(values, world());
  PetrovGalerkin method(test::parts_of(model, values, test::cosines(*model->sources(), 1, values.count, 8),
                                       {{1.0, 0, 8}}, test::lspg_test),
                        newton_of(values), kiln::Projection::Factors::every_iteration);
  EXPECT_EQ(largest_difference(march(method, values), kept), 0.0);
}

TEST(PetrovGalerkin, LineSearchTakesTheSameSolution) {
  Case values;
  values.steps = 10;
  const std::vector<double> plain = march(*of_kind("lspg", values, 8, world()), values);
  const std::shared_ptr<Model> model = model_of(values, world());
  NewtonSettings settings = newton_of(values);
  settings.line_search = true;
  PetrovGalerkin::Parts parts = test::parts_of(model, values, test::cosines(*model->sources(), 1, values.count, 8),
                                               {{1.0, 0, 8}}, test::lspg_test);
  PetrovGalerkin method(std::move(parts), settings);
  EXPECT_LT(largest_difference(march(method, values), plain), 1e-10);
}

/// A chain that knows no rate above a wall, as a material knows none beyond its table.
class Walled : public test::Chain {
 public:
  using Chain::Chain;
  void rate(ConstVectorView u, double time, VectorView f) const override {
    Chain::rate(u, time, f);
    constexpr double wall = 50.0;
    for (std::size_t i = 0; i < f.extent(0); ++i) {
      if (u(i) > wall) f(i) = std::numeric_limits<double>::quiet_NaN();
    }
  }
};

TEST(PetrovGalerkin, LineSearchTurnsBackFromWhereThereIsNoRate) {
  Case values;
  values.steps = 1;
  values.step = 0.1;
  values.power = 4e4;
  values.iterations = 100;
  const auto march_on = [&values](const std::shared_ptr<Model>& model, bool line_search) {
    NewtonSettings settings = newton_of(values);
    settings.line_search = line_search;
    PetrovGalerkin method(test::parts_of(model, values, test::cosines(*model->sources(), 1, values.count, 8),
                                         {{1.0, 0, 8}}, test::galerkin_test),
                          settings, kiln::Projection::Factors::every_iteration);
    return march(method, values);
  };
  const auto walled = std::make_shared<Walled>(test::input_of(values).sublist("model"), Model::Context{world()});
  EXPECT_THROW(march_on(walled, false), DivergenceError);
  EXPECT_LT(largest_difference(march_on(walled, true), march_on(model_of(values, world()), true)), 1e-6);
}

/// A chain whose Jacobian nobody has written.
class RateAlone : public test::Chain {
 public:
  using Chain::Chain;
  void apply_rate_jacobian(ConstVectorView, double, ConstMatrixView, MatrixView) const override {
    throw NotOffered("RateAlone", "apply_rate_jacobian");
  }
};

TEST_P(Projection, AnImplicitSchemeAsksForTheJacobianWhenItIsMade) {
  for (const char* scheme : {"backward euler", "explicit euler"}) {
    Case values;
    values.scheme = scheme;
    const auto method = [&](const char* jacobian) {
      values.jacobian = jacobian;
      const auto model = std::make_shared<RateAlone>(input_of(values).sublist("model"), Model::Context{world()});
      return of_kind(GetParam(), values, 8, model);
    };
    const auto make_scheme = [&values](Method& reduced) {
      Registry<TimeScheme>::create(input_of(values).sublist("time").sublist("scheme"),
                                   TimeScheme::Context{reduced, values.step});
    };
    if (values.scheme == "backward euler") {
      EXPECT_THROW(make_scheme(*method("matrix free")), InputError);
      EXPECT_THROW(make_scheme(*method("sparse")), InputError);
    } else {
      EXPECT_NO_THROW(make_scheme(*method("matrix free")));
    }
    EXPECT_NO_THROW(make_scheme(*method("finite difference")));
    EXPECT_NO_THROW(make_scheme(*method("diagonal")));
  }
}

}  // namespace
}  // namespace kiln
