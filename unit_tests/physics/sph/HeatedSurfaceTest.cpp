#include <gtest/gtest.h>

#include "unit_tests/physics/sph/ClosedForm.hpp"

/// Closed forms 3 and 4: heat that enters through the surface.
namespace kiln {
namespace {

double constant_flux_error(int cells, double* surface_error) {
  const double flux = 2e7;
  const double end = 1e-3;
  const double layer = std::sqrt(diffusivity * end);
  const double depth = 8.0 * layer;
  HeatCase heat_case = slab(cells, -depth, depth, 2.0);
  heat_case.heat_source =
      Teuchos::ParameterList("model.heat_source").set("type", std::string("uniform flux")).set("flux", flux);
  const auto model = heat_case.model(alone());
  VectorView u("u", model->positions().extent(0));
  model->initial_state(u);
  const double start = u(0);
  u = advanced(*model, u, end);
  const auto exact = [&](double, double, double z) {
    const double x = -z;
    return start + 2.0 * flux / 25.0 *
                       (layer / std::sqrt(M_PI) * std::exp(-x * x / (4.0 * layer * layer)) -
                        0.5 * x * std::erfc(x / (2.0 * layer)));
  };
  const std::size_t top = u.extent(0) - 1;
  const double expected = exact(0.0, 0.0, model->positions()(top, 2));
  *surface_error = std::abs(u(top) - expected) / (expected - start);
  return relative_error(*model, u, start, exact);
}

TEST(ClosedForms, HalfSpaceWithConstantFlux) {
  std::vector<double> spacings;
  std::vector<double> errors;
  std::vector<double> surface;
  for (const int cells : {40, 80, 160}) {
    spacings.push_back(8.0 * std::sqrt(diffusivity * 1e-3) / cells);
    surface.emplace_back();
    errors.push_back(constant_flux_error(cells, &surface.back()));
  }
  for (const double order : printed_orders("half-space with constant flux, h = 2 spacings", spacings, errors)) {
    EXPECT_NEAR(order, 1.5, 0.3);
  }
  for (const double order : printed_orders("  the same, surface particle alone", spacings, surface)) {
    EXPECT_NEAR(order, 1.0, 0.2);
  }
}

/// Eagar and Tsai, Welding Journal 62 (1983) 346: a moving Gaussian beam on a half-space z ≤ 0, constant properties.
double beam_error(double spacing) {
  const double power = 10.0;
  const double width = 50e-6;
  const double speed = 0.5;
  const double end = 1e-3;
  HeatCase heat_case;
  // The plane y = 0 is one of symmetry: half of the part, and half of the power enters there.
  heat_case.origin = {-0.32e-3, 0.0, -0.4e-3};
  heat_case.size = {1.2e-3, 0.4e-3, 0.4e-3};
  for (int axis = 0; axis < 3; ++axis)
    heat_case.count[axis] = static_cast<int>(std::lround(heat_case.size[axis] / spacing));
  heat_case.placement = "cells";
  heat_case.boundary = "mirrored";
  heat_case.material = HeatCase::constant_material(25.0, 650.0, 7500.0);
  heat_case.heat_source = HeatCase::beam(power);
  heat_case.heat_source.set("width", width).set("start", reals({0.0, 0.0})).set("velocity", reals({speed, 0.0}));
  const auto model = heat_case.model(alone());
  VectorView u("u", model->positions().extent(0));
  model->initial_state(u);
  const double start = u(0);
  u = advanced(*model, u, end);
  return relative_error(*model, u, start, [&](double x, double y, double z) {
    // With τ = s² the integrand is smooth; Simpson's rule.
    const int intervals = 80;
    const double last = std::sqrt(end);
    double integral = 0.0;
    for (int i = 0; i <= intervals; ++i) {
      const double s = last * i / intervals;
      const double tau = s * s;
      const double spread = 2.0 * diffusivity * tau + width * width;
      const double along = x - speed * (end - tau);
      const double down = i == 0 ? (z == 0.0 ? 0.0 : 1e9) : z * z / (4.0 * diffusivity * tau);
      const double factor = i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      integral += factor * 2.0 / spread * std::exp(-(along * along + y * y) / (2.0 * spread) - down);
    }
    integral *= last / intervals / 3.0;
    return start + power / (M_PI * 7500.0 * 650.0 * std::sqrt(4.0 * M_PI * diffusivity)) * integral;
  });
}

TEST(ClosedForms, MovingGaussianBeam) {
  const std::vector<double> spacings = {40e-6, 20e-6};
  std::vector<double> errors;
  for (const double spacing : spacings) errors.push_back(beam_error(spacing));
  const std::vector<double> orders =
      printed_orders("moving Gaussian beam, cells, mirrored, h = 1.5 spacings", spacings, errors);
  // An independent implementation of the same discretisation has 8.3 % and 3.2 %.
  EXPECT_NEAR(errors[0], 0.083, 0.002);
  EXPECT_NEAR(errors[1], 0.032, 0.001);
  EXPECT_NEAR(orders[0], 1.37, 0.1);
}

}  // namespace
}  // namespace kiln
