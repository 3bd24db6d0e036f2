#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {

/// Classical Runge–Kutta steps from 0 to `end`, small enough that the error is that of the particles: the spectrum of
/// the operator lies within twice its largest diagonal entry, and explicit fourth order is stable to 2.78.
inline VectorView advanced(const Model& model, VectorView u, double end) {
  const std::size_t number = u.extent(0);
  VectorView diagonal("diagonal", number);
  model.rate_jacobian_diagonal(u, 0.0, diagonal);
  double fastest = 0.0;
  for (std::size_t i = 0; i < number; ++i) fastest = std::max(fastest, -diagonal(i));
  const int steps = static_cast<int>(std::ceil(end * fastest / 0.7)) + 1;
  const double dt = end / steps;
  VectorView stage("stage", number);
  std::array<VectorView, 4> k;
  for (VectorView& slope : k) slope = VectorView("slope", number);
  for (int step = 0; step < steps; ++step) {
    const double time = step * dt;
    model.rate(u, time, k[0]);
    for (int s = 1; s < 4; ++s) {
      const double fraction = s == 3 ? 1.0 : 0.5;
      for (std::size_t i = 0; i < number; ++i) stage(i) = u(i) + fraction * dt * k[s - 1](i);
      model.rate(stage, time + fraction * dt, k[s]);
    }
    for (std::size_t i = 0; i < number; ++i) {
      u(i) += dt / 6.0 * (k[0](i) + 2.0 * k[1](i) + 2.0 * k[2](i) + k[3](i));
    }
  }
  return u;
}

/// ‖u − exact‖₂ / ‖exact − reference‖₂ over all particles.
inline double relative_error(const Model& model, const VectorView& u, double reference,
                             const std::function<double(double, double, double)>& exact) {
  double difference = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < u.extent(0); ++i) {
    const auto positions = model.positions();
    const double expected = exact(positions(i, 0), positions(i, 1), positions(i, 2));
    difference += std::pow(u(i) - expected, 2);
    scale += std::pow(expected - reference, 2);
  }
  return std::sqrt(difference / scale);
}

/// Prints errors at successive spacings with the orders between them and returns the orders.
inline std::vector<double> printed_orders(const std::string& title, const std::vector<double>& spacings,
                                          const std::vector<double>& errors) {
  std::vector<double> orders;
  std::printf("%s\n", title.c_str());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::printf("  spacing %8.3f um  relative L2 error %.3e", 1e6 * spacings[i], errors[i]);
    if (i > 0) {
      orders.push_back(std::log(errors[i] / errors[i - 1]) / std::log(spacings[i] / spacings[i - 1]));
      std::printf("  order %.2f", orders.back());
    }
    std::printf("\n");
  }
  return orders;
}

/// A slab of `cells` cells across its thickness, along z from `bottom` to `bottom + thickness`, endless in x and y:
/// mirror images of a single cell.
inline HeatCase slab(int cells, double bottom, double thickness, double smoothing_length) {
  HeatCase heat_case;
  const double spacing = thickness / cells;
  heat_case.origin = {0.0, 0.0, bottom};
  heat_case.size = {spacing, spacing, thickness};
  heat_case.count = {1, 1, cells};
  heat_case.placement = "cells";
  heat_case.boundary = "mirrored";
  heat_case.smoothing_length = smoothing_length;
  heat_case.heat_source = HeatCase::no_source();
  heat_case.material = HeatCase::constant_material(25.0, 650.0, 7500.0);
  return heat_case;
}

/// k/(ρc) in m²/s of slab()'s material.
constexpr double diffusivity = 25.0 / (7500.0 * 650.0);

}  // namespace kiln
