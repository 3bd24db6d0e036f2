#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "Projections.hpp"
#include "framework/model/PointRates.hpp"
#include "framework/queries/PointBlock.hpp"
#include "framework/time/TimeLoop.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using test::Case;
using test::self;

/// A small chain, trained in four time windows.
Case chain(const std::string& folder) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.tolerance = 1e-6;
  values.iterations = 40;
  values.refresh = 10;
  values.reaction = 100.0;  // so that numbers of iterations differ from point to point
  values.basis_rank = 4;
  values.residual_rank = 6;
  values.samples = 15;
  values.windows = 4;
  values.clustering = "per row";
  values.method = "gnat";
  return values;
}

Case trained(const TestFolder& folder, const char* scheme = "backward euler") {
  Case values = chain(folder / ("rank" + std::to_string(test::world()->getRank())));
  values.scheme = scheme;
  std::filesystem::create_directory(values.folder);
  test::train(values, self());
  return values;
}

/// States of two particles after every step, for one point.
using History = std::vector<double>;
const std::vector<LocalIndex> places{1, 7};

class Running {
 public:
  explicit Running(const Case& values)
      : values_(values),
        input_(test::input_of(values)),
        method_(Registry<Method>::create(input_.sublist("method"), Method::Context{input_, self()})),
        scheme_(Registry<TimeScheme>::create(input_.sublist("time").sublist("scheme"),
                                             TimeScheme::Context{*method_, values.step})) {}

  Method& method() { return *method_; }
  std::unique_ptr<PointBlock> block(std::size_t points) {
    return dynamic_cast<AdvancesTogether&>(*method_).point_block({points, *scheme_, values_.step, places});
  }

  std::vector<History> together(const ParameterPoints& points, std::vector<PointOutcome>* outcomes = nullptr) {
    return together(*block(points.count()), points, outcomes);
  }

  std::vector<History> together(PointBlock& running, const ParameterPoints& points,
                                std::vector<PointOutcome>* outcomes = nullptr) {
    std::vector<History> histories(points.count());
    const MatrixView told("told", points.count(), places.size());
    running.start(points);
    for (int step = 1; step <= values_.steps; ++step) {
      running.advance(step, step * values_.step);
      running.tell(told);
      for (std::size_t point = 0; point < points.count(); ++point) {
        for (std::size_t k = 0; k < places.size(); ++k) histories[point].push_back(told(point, k));
      }
    }
    if (outcomes != nullptr) *outcomes = running.outcomes();
    return histories;
  }

  History alone(const ParameterPoints& points, std::size_t point, LoopTotals& totals) {
    points.set(point, method_->parameters());
    const auto reader = method_->reader(places);
    const VectorView x("x", local_size(*method_->coordinates())), told("told", places.size());
    method_->initial(x);
    scheme_->start(x, 0.0);
    History history;
    for (int step = 1; step <= values_.steps; ++step) {
      const SolveReport solve = scheme_->advance(x, step * values_.step);
      totals.residuals += solve.residuals;
      totals.iterations += solve.iterations;
      reader(x, told);
      history.insert(history.end(), told.data(), told.data() + told.extent(0));
    }
    return history;
  }

 private:
  Case values_;
  Teuchos::ParameterList input_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<TimeScheme> scheme_;
};

/// Eleven points: a group of eight lanes and a part of one.
ParameterPoints eleven() {
  ParameterPoints points{{"power", "velocity"}, {}};
  for (int point = 0; point < 11; ++point) points.values.push_back({30.0 + 4.0 * point, 5.0 + 0.1 * (point % 4)});
  return points;
}

double relative_difference(const History& a, const History& b) {
  double largest = a.size() == b.size() && !a.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  double scale = 0.0;
  for (const double value : b) scale = std::max(scale, std::abs(value));
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]) / scale);
  return largest;
}

struct Setting {
  const char* method;
  const char* scheme;
  const char* jacobian;
  double tolerance = 1e-12;
};
void PrintTo(const Setting& s, std::ostream* out) { *out << s.method << ", " << s.scheme << ", " << s.jacobian; }
class Together : public testing::TestWithParam<Setting> {};

TEST_P(Together, EachPointIsThatOfARunOfItsOwn) {
  const TestFolder folder;
  Case values = trained(folder, GetParam().scheme);
  values.method = GetParam().method;
  values.jacobian = GetParam().jacobian;
  const ParameterPoints points = eleven();
  Running running(values);
  std::vector<PointOutcome> outcomes;
  const std::vector<History> together = running.together(points, &outcomes);
  std::set<long long> residuals;
  for (std::size_t point = 0; point < points.count(); ++point) {
    Running alone(values);
    LoopTotals totals;
    const History own = alone.alone(points, point, totals);
    EXPECT_LT(relative_difference(together[point], own), GetParam().tolerance) << "point " << point;
    EXPECT_EQ(outcomes[point].residuals, totals.residuals) << "point " << point;
    EXPECT_EQ(outcomes[point].iterations, totals.iterations) << "point " << point;
    EXPECT_EQ(outcomes[point].steps, values.steps);
    EXPECT_EQ(outcomes[point].divergence, "");
    residuals.insert(totals.residuals);
  }
  // The points differ, and so do their numbers of iterations, where there are any: else idle lanes were not tested.
  EXPECT_GT(relative_difference(together[0], together[10]), 1e-2);
  if (GetParam().scheme != std::string("explicit euler")) {
    EXPECT_GT(residuals.size(), 1u);
  }
  // A second block of the same method starts anew.
  EXPECT_EQ(running.together(points), together);
}

INSTANTIATE_TEST_SUITE_P(
    Queries, Together,
    testing::Values(Setting{"gnat", "backward euler", "diagonal"}, Setting{"gnat", "bdf2", "diagonal"},
                    Setting{
                        "gnat", "trapezoidal",
                        "matrix free"},  // A difference quotient magnifies round-off by the inverse of its step, 1e8.
                    Setting{"gnat", "backward euler", "finite difference", 1e-10},
                    Setting{"ptrom", "backward euler", "diagonal"}, Setting{"lspg", "backward euler", "diagonal"},
                    Setting{"galerkin", "bdf2", "sparse"}, Setting{"galerkin", "explicit euler", "diagonal"}));

TEST(Together, AnswersDoNotDependOnTheOtherPointsOfTheBlock) {
  const TestFolder folder;
  const Case values = trained(folder);
  const ParameterPoints points = eleven();
  Running running(values);
  const std::vector<History> all = running.together(points);
  ParameterPoints others = points;
  for (std::size_t point = 0; point < points.count(); ++point) {
    if (point != 3 && point != 9) others.values[point][0] *= 1.07;
  }
  const std::vector<History> again = running.together(others);
  EXPECT_EQ(again[3], all[3]);
  EXPECT_EQ(again[9], all[9]);
  EXPECT_NE(again[4], all[4]);
}

TEST(Together, LeavesADivergedPointBehind) {
  const TestFolder folder;
  const Case values = trained(folder);
  ParameterPoints points = eleven();
  Running running(values);
  const std::vector<History> all = running.together(points);
  points.values[2][0] = 1e300;  // its cube overflows
  std::vector<PointOutcome> outcomes;
  const std::vector<History> marked = running.together(points, &outcomes);
  LoopTotals totals;
  Running alone(values);
  std::string expected;
  try {
    alone.alone(points, 2, totals);
  } catch (const DivergenceError& error) {
    expected = error.at_step(1).what();
  }
  ASSERT_NE(expected, "");
  for (std::size_t point = 0; point < points.count(); ++point) {
    if (point == 2) {
      EXPECT_EQ(outcomes[point].divergence, expected);
      EXPECT_LT(outcomes[point].steps, values.steps);
    } else {
      EXPECT_EQ(marked[point], all[point]) << "point " << point;
      EXPECT_EQ(outcomes[point].divergence, "");
    }
  }
}

TEST(Together, ABlockServesOtherPointsLikeANewOne) {
  const TestFolder folder;
  const Case values = trained(folder);
  ParameterPoints first = eleven(), second = eleven();
  first.values[2][0] = 1e300;  // diverges, and must leave nothing behind
  for (std::vector<double>& point : second.values) point[0] *= 1.07;
  Running running(values);
  std::vector<PointOutcome> outcomes, expected_outcomes;
  const std::vector<History> expected = running.together(second, &expected_outcomes);
  const auto block = running.block(11);
  EXPECT_THROW(block->advance(1, values.step), std::logic_error);
  const std::vector<History> before = running.together(*block, first, &outcomes);
  EXPECT_NE(outcomes[2].divergence, "");
  EXPECT_NE(before[3], expected[3]);
  EXPECT_EQ(running.together(*block, second, &outcomes), expected);
  for (std::size_t point = 0; point < 11; ++point) {
    EXPECT_EQ(outcomes[point].divergence, "");
    EXPECT_EQ(outcomes[point].residuals, expected_outcomes[point].residuals);
  }
  EXPECT_THROW(block->start({first.names, {first.values[0]}}), std::invalid_argument);
}

void expect_refusal(const Case& values, const Teuchos::ParameterList& input, const std::string& path) {
  const auto method = Registry<Method>::create(input.sublist("method"), Method::Context{input, self()});
  const auto scheme =
      Registry<TimeScheme>::create(input.sublist("time").sublist("scheme"), TimeScheme::Context{*method, values.step});
  try {
    dynamic_cast<AdvancesTogether&>(*method).point_block({eleven().count(), *scheme, values.step, places});
    ADD_FAILURE() << path << " was not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().path, path);
    EXPECT_NE(error.problems().front().expected.find("queries.together: 1"), std::string::npos);
  }
}

TEST(Together, RefusesByNameWhatItDoesNotOffer) {
  const TestFolder folder;
  Case values = trained(folder);
  Teuchos::ParameterList input = test::input_of(values);
  input.sublist("time").sublist("newton").set("line_search", true);
  expect_refusal(values, input, "time.newton.line_search");
  input = test::input_of(values);
  input.sublist("method").set("factors", std::string("every iteration"));
  expect_refusal(values, input, "method.factors");
  values.method = "lspg";  // gnat insists on the scheme it was trained with
  values.scheme = "rk4";
  expect_refusal(values, test::input_of(values), "time.scheme");
}

/// Every model answers for several points, also one that offers its rate alone; all states differ.
TEST(PointRates, OfAModelThatHasOnlyItsRate) {
  Case values;
  values.model = "test rate only";
  values.components = 2;
  // Live parameters are the wrapped chain's and not listed: the points differ in their states.
  const auto model = test::model_of(values, self());
  const ParameterPoints points{{}, std::vector<std::vector<double>>(3)};
  const std::size_t size = 2 * local_size(*model->sources()), rows = 2 * local_size(*model->rows());
  const MatrixView u("u", 3, size), f("f", 3, rows);
  for (std::size_t point = 0; point < 3; ++point) {
    for (std::size_t i = 0; i < size; ++i) u(point, i) = std::sin(0.3 * static_cast<double>(i * (point + 1)));
  }
  model->at_points(points)->rates(u, 0.1, {1, 1, 1}, f);
  const VectorView one("one", size), rate("rate", rows);
  for (std::size_t point = 0; point < 3; ++point) {
    take_point(u, point, one);
    model->rate(one, 0.1, rate);
    for (std::size_t i = 0; i < rows; ++i) EXPECT_EQ(f(point, i), rate(i));
  }
}

TEST(PointRates, TakeEachPointsParameters) {
  const auto model = test::model_of(Case(), self());
  const ParameterPoints points{{"power"}, {{10.0}, {0.0}}};
  const MatrixView u("u", 2, local_size(*model->sources())), f("f", 2, local_size(*model->rows()));
  model->at_points(points)->rates(u, 0.05, {1, 1}, f);
  double largest[2] = {};
  for (std::size_t i = 0; i < f.extent(1); ++i) {
    for (int point = 0; point < 2; ++point) largest[point] = std::max(largest[point], std::abs(f(point, i)));
  }
  EXPECT_GT(largest[0], 9.0);
  EXPECT_EQ(largest[1], 0.0);
  EXPECT_THROW(model->at_points({{"powr"}, {{1.0}}}), InputError);
}

}  // namespace
}  // namespace kiln
