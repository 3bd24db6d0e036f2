#include <gtest/gtest.h>

#include "HeatCase.hpp"
#include "framework/model/PointRates.hpp"

namespace kiln {
namespace {

/// Thirteen points in states of their own: temperatures in every phase, beyond both ends of the table, and one that is
/// not a number; powers, widths and places of the beam of their own.
struct Points {
  explicit Points(const Model& model, std::size_t count = 13)
      : u("u", count, model.sources()->getNodeNumElements()), f("f", count, model.rows()->getNodeNumElements()) {
    parameters.names = {"heat_source.power", "heat_source.width", "heat_source.start.x"};
    for (std::size_t point = 0; point < count; ++point) {
      const double k = static_cast<double>(point);
      parameters.values.push_back({30.0 + k, (50.0 + k) * 1e-6, 0.02e-3 * k});
      for (std::size_t j = 0; j < u.extent(1); ++j) {
        const GlobalIndex id = model.sources()->getGlobalElement(static_cast<LocalIndex>(j));
        u(point, j) = rough_temperature(id + static_cast<GlobalIndex>(1000 * point));
      }
      u(point, point) = point % 2 == 0 ? 150.0 - k : 6000.0 + 100.0 * k;
      u(point, point + 1) = 200.0 + 1.0 * k;
    }
    u(0, 20) = 6000.0;
    u(1, 20) = 200.0;
  }
  PointMask all() const { return PointMask(parameters.count(), 1); }
  ParameterPoints parameters;
  MatrixView u, f;
};

void expect_rates_of_each(Model& model, const Points& points, double time, double tolerance) {
  const auto rates = model.at_points(points.parameters);
  // Twice: what is kept of a time must serve again, and not another time.
  for (const double at : {time, 2.0 * time, time}) {
    rates->rates(points.u, at, points.all(), points.f);
    const VectorView u("u", points.u.extent(1)), f("f", points.f.extent(1));
    for (std::size_t point = 0; point < points.parameters.count(); ++point) {
      points.parameters.set(point, model.parameters());
      take_point(points.u, point, u);
      model.rate(u, at, f);
      double largest = 0.0;
      for (std::size_t i = 0; i < f.extent(0); ++i) largest = std::max(largest, std::abs(f(i)));
      EXPECT_GT(largest, 0.0);
      for (std::size_t i = 0; i < f.extent(0); ++i) {
        EXPECT_NEAR(points.f(point, i), f(i), tolerance * largest) << "point " << point << ", row " << i;
      }
    }
  }
}

TEST(HeatPoints, RatesAreThoseOfEachPointOnTheWholePart) {
  const auto model = HeatCase().model();
  expect_rates_of_each(*model, Points(*model), 1e-4, 1e-14);
}

TEST(HeatPoints, RatesAreThoseOfEachPointOnASampleMesh) {
  const auto model = HeatCase().model();
  const auto sampled = model->sampled({3, 100, 101, 330, 590, 600, 640});
  for (const std::size_t count : {1, 8, 13, 16}) expect_rates_of_each(*sampled, Points(*sampled, count), 1e-4, 1e-14);
}

TEST(HeatPoints, ARateThatIsNotANumberStaysWithItsPoint) {
  const auto model = HeatCase().model(alone());
  Points points(*model);
  const auto rates = model->at_points(points.parameters);
  rates->rates(points.u, 1e-4, points.all(), points.f);
  MatrixView before("before", points.f.extent(0), points.f.extent(1));
  Kokkos::deep_copy(before, points.f);
  points.u(5, 40) = std::nan("");
  rates->rates(points.u, 1e-4, points.all(), points.f);
  EXPECT_TRUE(std::isnan(points.f(5, 40)));
  for (std::size_t point = 0; point < 13; ++point) {
    if (point == 5) continue;
    for (std::size_t i = 0; i < points.f.extent(1); ++i) EXPECT_EQ(points.f(point, i), before(point, i));
  }
}

/// What is kept of a group's states must not pass for that of states the group was not asked about.
TEST(HeatPoints, AnswerForTheWantedPointsAndLaterForTheOthers) {
  const auto model = HeatCase().model(alone());
  Points points(*model, 19);
  const auto rates = model->at_points(points.parameters);
  rates->rates(points.u, 1e-4, points.all(), points.f);
  for (std::size_t i = 0; i < points.u.size(); ++i) points.u.data()[i] += 10.0;
  const MatrixView expected("expected", points.f.extent(0), points.f.extent(1));
  model->at_points(points.parameters)->rates(points.u, 1e-4, points.all(), expected);
  const auto expect_rates = [&](std::size_t first, std::size_t last) {
    for (std::size_t point = first; point < last; ++point) {
      for (std::size_t i = 0; i < expected.extent(1); ++i) EXPECT_EQ(points.f(point, i), expected(point, i)) << point;
    }
  };
  PointMask wanted(19, 0);
  wanted[11] = 1;
  Kokkos::deep_copy(points.f, -1.0);
  rates->rates(points.u, 1e-4, wanted, points.f);
  expect_rates(11, 12);
  EXPECT_EQ(points.f(0, 0), -1.0);
  EXPECT_EQ(points.f(18, 0), -1.0);
  rates->rates(points.u, 1e-4, points.all(), points.f);
  expect_rates(0, 19);
}

TEST(HeatPoints, GoOverToOtherPoints) {
  const auto model = HeatCase().model(alone());
  Points points(*model, 11);
  const auto rates = model->at_points(points.parameters);
  rates->rates(points.u, 1e-4, points.all(), points.f);
  for (std::vector<double>& point : points.parameters.values) point[0] *= 1.5;
  const MatrixView expected("expected", points.f.extent(0), points.f.extent(1));
  model->at_points(points.parameters)->rates(points.u, 1e-4, points.all(), expected);
  EXPECT_NE(points.f(3, 600), expected(3, 600));
  rates->take(points.parameters);
  // At the same time and in the same states: what was kept of the points before must not serve.
  rates->rates(points.u, 1e-4, points.all(), points.f);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(points.f.data()[i], expected.data()[i]);
}

/// Sources with vectors of points of their own, and those that go point by point.
TEST(HeatPoints, FluxesAreThoseOfEachPoint) {
  const auto model = HeatCase().model(alone());
  const PositionView positions("positions", 21);
  for (std::size_t i = 0; i < positions.extent(0); ++i) {
    positions(i, 0) = 0.02e-3 * static_cast<double>(i);
    positions(i, 1) = 0.3e-3 - 0.01e-3 * static_cast<double>(i);
  }
  Teuchos::ParameterList printed = HeatCase::beam(40.0);
  printed.set("normalisation", std::string("printed"));
  Teuchos::ParameterList uniform("model.heat_source");
  uniform.set("type", std::string("uniform flux")).set("flux", 2e7);
  for (const Teuchos::ParameterList& list : {HeatCase::beam(40.0), printed, uniform}) {
    const auto source = Registry<HeatSource>::create(list, {});
    const bool is_beam = list.isParameter("width");
    const auto set = [&](std::size_t point) {
      if (!is_beam) return;
      const double k = static_cast<double>(point);
      const std::pair<const char*, double> values[] = {{"power", 30.0 + k},
                                                       {"width", (50.0 + k) * 1e-6},
                                                       {"start.x", 0.01e-3 * k},
                                                       {"start.y", 0.1e-3 + 1e-5 * k},
                                                       {"velocity.x", 0.4 + 0.02 * k},
                                                       {"velocity.y", -0.1 * k}};
      for (const auto& [name, value] : values) source->parameters().set(name, value);
    };
    for (const std::size_t count : {1, 8, 13}) {
      const MatrixView q("q", count, positions.extent(0));
      source->at_points(count, set)->flux(1e-4, positions, q);
      const VectorView expected("expected", positions.extent(0));
      for (std::size_t point = 0; point < count; ++point) {
        set(point);
        source->flux(1e-4, positions, expected);
        for (std::size_t i = 0; i < positions.extent(0); ++i) {
          EXPECT_GT(expected(i), 0.0);
          EXPECT_NEAR(q(point, i), expected(i), 1e-14 * expected(i)) << "point " << point << ", position " << i;
        }
      }
    }
  }
}

TEST(HeatPoints, RefuseOtherNumbersOfPointsAndUnknownParameters) {
  const auto model = HeatCase().model();
  const Points points(*model, 3), others(*model, 4);
  EXPECT_THROW(model->at_points(points.parameters)->rates(others.u, 0.0, others.all(), others.f),
               std::invalid_argument);
  EXPECT_THROW(model->at_points({{"heat_source.powr"}, {{1.0}}}), InputError);
}

}  // namespace
}  // namespace kiln
