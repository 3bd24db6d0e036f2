#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <cstdio>

#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

double summed(double value) {
  double sum = 0.0;
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, 1, &value, &sum);
  return sum;
}

HeatCase cells(const std::string& boundary) {
  HeatCase heat_case;
  heat_case.placement = "cells";
  heat_case.boundary = boundary;
  return heat_case;
}

/// Largest difference of two models' rates relative to the largest rate; `reference` lives on each rank alone.
double largest_difference(const HeatModel& model, const HeatModel& reference, double time) {
  const VectorView f = rate_of(model, rough_state(model), time);
  const VectorView expected = rate_of(reference, rough_state(reference), time);
  double difference = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < f.extent(0); ++i) {
    const GlobalIndex id = model.rows()->getGlobalElement(static_cast<LocalIndex>(i));
    const double value = expected(reference.rows()->getLocalElement(id));
    difference = std::max(difference, std::abs(f(i) - value));
    scale = std::max(scale, std::abs(value));
  }
  return f.extent(0) == 0 ? 0.0 : difference / scale;
}

TEST(HeatModel, MapsHoldEveryParticleOnceAndRowsFirst) {
  const auto model = HeatCase().model();
  EXPECT_EQ(model->rows()->getGlobalNumElements(), 648u);
  EXPECT_TRUE(model->rows()->isOneToOne());
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(model->rows()->getNodeNumElements()); ++i) {
    ASSERT_EQ(model->sources()->getGlobalElement(i), model->rows()->getGlobalElement(i));
    if (i > 0) {
      ASSERT_LT(model->rows()->getGlobalElement(i - 1), model->rows()->getGlobalElement(i));
    }
  }
}

TEST(HeatModel, RateDoesNotDependOnTheNumberOfRanks) {
  for (const char* boundary : {"as printed", "mirrored"}) {
    const HeatCase heat_case = cells(boundary);
    const double difference = largest_difference(*heat_case.model(), *heat_case.model(alone()), 2e-4);
    EXPECT_LE(difference, 1e-15) << boundary;
  }
}

TEST(HeatModel, EnergyBalance) {
  HeatCase nodes;
  for (const HeatCase& heat_case : {nodes, cells("as printed"), cells("mirrored")}) {
    const auto model = heat_case.model();
    const VectorView u = rough_state(*model);
    const double time = 3e-4;
    const VectorView f = rate_of(*model, u, time);
    const auto source = Registry<HeatSource>::create(heat_case.heat_source, {});
    const HeatDomain& domain = model->domain();
    VectorView q("q", u.extent(0));
    source->flux(time, domain.positions, q);
    double stored = 0.0;
    double absorbed = 0.0;
    double exchanged = 0.0;
    for (std::size_t i = 0; i < f.extent(0); ++i) {
      const double power = domain.masses(i) * model->material().at(u(i)).specific_heat * f(i);
      stored += power;
      exchanged += std::abs(power);
      absorbed += q(i) * domain.areas(i);
    }
    stored = summed(stored);
    absorbed = summed(absorbed);
    exchanged = summed(exchanged);
    EXPECT_GT(absorbed, 1.0);
    EXPECT_GT(exchanged, absorbed);
    EXPECT_NEAR(stored, absorbed, 1e-13 * exchanged) << heat_case.boundary << ", " << heat_case.placement;
  }
}

TEST(HeatModel, TakesANewParameterAtTheSameTime) {
  const HeatCase heat_case;
  const auto model = heat_case.model();
  const VectorView u = rough_state(*model);
  const VectorView before = rate_of(*model, u, 3e-4);
  model->parameters().set("heat_source.power", 2.0 * model->parameters().get("heat_source.power"));
  const VectorView f = rate_of(*model, u, 3e-4);
  const auto fresh = heat_case.model();
  fresh->parameters().set("heat_source.power", model->parameters().get("heat_source.power"));
  const VectorView expected = rate_of(*fresh, u, 3e-4);
  double change = 0.0;
  for (std::size_t i = 0; i < f.extent(0); ++i) {
    EXPECT_EQ(f(i), expected(i));
    change += std::abs(f(i) - before(i));
  }
  EXPECT_GT(summed(change), 0.0);
}

TEST(HeatModel, RateHasNoMemory) {
  const auto model = HeatCase().model();
  contract::check_rate_has_no_memory(*model, 3e-4, 2e-4);
  const auto sample = model->sampled({3, 100, 101, 400});
  contract::check_rate_has_no_memory(*sample, 3e-4, 2e-4);
}

TEST(HeatModel, UniformTemperatureIsSteady) {
  HeatCase heat_case;
  heat_case.heat_source = HeatCase::no_source();
  const auto model = heat_case.model();
  VectorView u("u", model->sources()->getNodeNumElements());
  model->initial_state(u);
  for (std::size_t i = 0; i < u.extent(0); ++i) ASSERT_EQ(u(i), 293.15);
  const VectorView f = rate_of(*model, u, 0.0);
  for (std::size_t i = 0; i < f.extent(0); ++i) ASSERT_EQ(f(i), 0.0);
}

TEST(HeatModel, MassesAreThePartsDensityTimesItsVolume) {
  const auto model = HeatCase().model();
  double mass = 0.0;
  for (std::size_t i = 0; i < model->rows()->getNodeNumElements(); ++i) mass += model->domain().masses(i);
  const double density = model->material().at(293.15).density;
  EXPECT_NEAR(summed(mass), density * 0.48e-3 * 0.36e-3 * 0.24e-3, 1e-12 * density * 0.41e-10);
}

/// Σ_j V_j (−2 r·∇W/r²) (x_a − x_a,i)²/2 is the factor by which the operator scales the second derivative along a.
TEST(HeatModel, InteriorOperatorIsConsistent) {
  for (const auto& [kernel, expected] : {std::pair{"cubic spline", 1.01012}, std::pair{"wendland c2", 1.00062}}) {
    HeatCase heat_case;
    heat_case.size = {9.0, 9.0, 9.0};
    heat_case.count = {9, 9, 9};
    heat_case.placement = "cells";
    heat_case.kernel = kernel;
    const auto model = heat_case.model(alone());
    const HeatDomain& domain = model->domain();
    const LocalIndex centre = 4 + 9 * (4 + 9 * 4);
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      for (std::size_t pair = domain.pairs.offsets(centre); pair < domain.pairs.offsets(centre + 1); ++pair) {
        const double offset = domain.positions(domain.pairs.neighbours(pair), axis) - domain.positions(centre, axis);
        sum += -2.0 * domain.weights(pair) * offset * offset / 2.0;
      }
      if (axis == 0 && Tpetra::getDefaultComm()->getRank() == 0) {
        std::printf("interior operator, %s, h = 1.5 spacings: %.5f of the second derivative\n", kernel, sum);
      }
      EXPECT_NEAR(sum, expected, 1e-5);
    }
  }
}

/// A cosine that is even about both faces is an eigenvector of the mirrored operator: the rate over the deviation is
/// the same at a corner, on a face and inside.
TEST(HeatModel, MirroredCornerHasTheNeighboursOfTheInterior) {
  HeatCase heat_case;
  heat_case.size = {9.0, 9.0, 9.0};
  heat_case.count = {9, 9, 9};
  const auto along_x = [&heat_case](const std::string& boundary) {
    heat_case.placement = "cells";
    heat_case.boundary = boundary;
    const auto model = heat_case.model(alone());
    // An even field about the faces x = 0 and x = 9 with one wave length in 18.
    VectorView u("u", 729);
    for (std::size_t i = 0; i < 729; ++i) u(i) = 1000.0 + std::cos(M_PI * model->positions()(i, 0) / 9.0);
    heat_case.heat_source = HeatCase::no_source();
    heat_case.material = HeatCase::constant_material(20.0, 500.0, 8000.0);
    const auto conducting = heat_case.model(alone());
    const VectorView f = rate_of(*conducting, u, 0.0);
    const LocalIndex corner = 0;
    const LocalIndex inside = 9 * (4 + 9 * 4);
    const LocalIndex next = 4 + 9 * (4 + 9 * 4) - 1;
    return std::array<double, 3>{f(corner) / (u(corner) - 1000.0), f(inside) / (u(inside) - 1000.0),
                                 f(next) / (u(next) - 1000.0)};
  };
  const auto mirrored = along_x("mirrored");
  EXPECT_NEAR(mirrored[0] / mirrored[2], 1.0, 1e-10);
  EXPECT_NEAR(mirrored[1] / mirrored[2], 1.0, 1e-10);
  const auto printed = along_x("as printed");
  EXPECT_LT(printed[0] / mirrored[2], 0.9);
}

TEST(HeatModel, ParametersAreLive) {
  const HeatCase heat_case;
  const auto model = heat_case.model();
  std::vector<std::string> names;
  for (const Parameter& parameter : model->parameters().list()) names.push_back(parameter.name);
  EXPECT_EQ(names, (std::vector<std::string>{"heat_source.power", "heat_source.width", "heat_source.velocity.x",
                                             "heat_source.velocity.y", "heat_source.start.x", "heat_source.start.y"}));
  model->parameters().set("heat_source.power", 80.0);
  model->parameters().set("heat_source.width", 70e-6);
  model->parameters().set("heat_source.velocity.x", 1.0);
  model->parameters().set("heat_source.velocity.y", -0.2);
  model->parameters().set("heat_source.start.x", 0.05e-3);
  model->parameters().set("heat_source.start.y", 0.2e-3);
  HeatCase changed = heat_case;
  changed.heat_source.set("power", 80.0).set("width", 70e-6);
  changed.heat_source.set("start", reals({0.05e-3, 0.2e-3})).set("velocity", reals({1.0, -0.2}));
  EXPECT_LE(largest_difference(*model, *changed.model(alone()), 2e-4), 1e-15);
  if (model->rows()->getComm()->getSize() == 1) {
    EXPECT_GT(largest_difference(*model, *heat_case.model(alone()), 2e-4), 1e-3);
  }
  EXPECT_THROW(model->parameters().set("heat_source.width", 0.0), InputError);
  EXPECT_THROW(model->parameters().set("heat_source.power", -1e-9), InputError);
  EXPECT_THROW(model->parameters().set("heat_source.velocity.x", std::nan("")), InputError);
  EXPECT_EQ(model->parameters().get("heat_source.width"), 70e-6);
}

TEST(HeatModel, BeamDepositsItsPowerOrPiTimesIt) {
  for (const auto& [normalisation, factor] : {std::pair{"standard", 1.0}, std::pair{"printed", M_PI}}) {
    Teuchos::ParameterList list = HeatCase::beam(40.0);
    list.set("normalisation", std::string(normalisation));
    const auto beam = Registry<HeatSource>::create(list, {});
    const int n = 200;
    const double step = 10e-6;
    PositionView grid("grid", n * n);
    for (int i = 0; i < n * n; ++i) {
      grid(i, 0) = (i % n - n / 2) * step;
      grid(i, 1) = (i / n - n / 2) * step;
    }
    VectorView q("q", n * n);
    beam->flux(1e-4, grid, q);
    double power = 0.0;
    int hottest = 0;
    for (int i = 0; i < n * n; ++i) {
      power += q(i) * step * step;
      if (q(i) > q(hottest)) hottest = i;
    }
    EXPECT_NEAR(power, 40.0 * factor, 1e-9);
    EXPECT_NEAR(grid(hottest, 0), 0.15e-3, 0.51 * step);
    EXPECT_NEAR(grid(hottest, 1), 0.16e-3, 0.51 * step);
  }
}

TEST(HeatModel, BeamIsEquationNineWhoeverIsBeside) {
  const auto beam = Registry<HeatSource>::create(HeatCase::beam(40.0), {});
  const double width = HeatCase::beam(40.0).get<double>("width");
  constexpr int most = 21;
  PositionView places("places", most);
  for (int i = 0; i < most; ++i) {
    places(i, 0) = 0.15e-3 + 7e-6 * i;
    places(i, 1) = 0.16e-3 - 13e-6 * i;
    places(i, 2) = 1.0 + i;
  }
  VectorView all("q", most);
  beam->flux(1e-4, places, all);
  for (int count = 0; count < most; ++count) {
    const std::pair<int, int> some(most - count, most);
    VectorView q("q", count);
    beam->flux(1e-4, Kokkos::subview(places, some, Kokkos::ALL), q);
    for (int i = 0; i < count; ++i) EXPECT_EQ(q(i), all(most - count + i)) << count << " places, place " << i;
  }
  for (int i = 0; i < most; ++i) {
    const double r2 = std::pow(places(i, 0) - 0.15e-3, 2) + std::pow(places(i, 1) - 0.16e-3, 2);
    const double expected = 40.0 / (2.0 * M_PI * width * width) * std::exp(-r2 / (2.0 * width * width));
    EXPECT_NEAR(all(i), expected, 1e-12 * expected + 1e-300) << "place " << i;
  }
}

}  // namespace
}  // namespace kiln
