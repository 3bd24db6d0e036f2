#include "physics/sph/PairWeights.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace kiln {
namespace {

using HostPositions = Kokkos::View<const double* [3], Kokkos::LayoutRight, Kokkos::HostSpace>;

/// Squared distances along one axis from a particle to another one and to its images, where below the support's.
std::vector<double> squared_offsets(double i, double j, double lower, double upper, double squared_support) {
  const double period = 2.0 * (upper - lower);
  std::vector<double> squares;
  const auto add = [&](double offset) {
    if (offset * offset < squared_support) squares.push_back(offset * offset);
  };
  const int periods = static_cast<int>(std::ceil(std::sqrt(squared_support) / period)) + 1;
  for (int n = -periods; n <= periods; ++n) {
    add((i - j) + n * period);
    add((i - lower) + (j - lower) + n * period);
  }
  return squares;
}

double direct_weight(const HostPositions& positions, LocalIndex i, LocalIndex j, const Kernel& kernel) {
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) square += std::pow(positions(i, axis) - positions(j, axis), 2);
  return kernel.gradient_over_distance(std::sqrt(square));
}

double mirrored_weight(const HostPositions& positions, LocalIndex i, LocalIndex j, const Kernel& kernel,
                       double squared_support, const Box& faces) {
  std::array<std::vector<double>, 3> squares;
  for (int axis = 0; axis < 3; ++axis) {
    squares[axis] =
        squared_offsets(positions(i, axis), positions(j, axis), faces.lower[axis], faces.upper[axis], squared_support);
  }
  double weight = 0.0;
  for (const double x : squares[0]) {
    for (const double y : squares[1]) {
      for (const double z : squares[2]) {
        if (x + y + z < squared_support) weight += kernel.gradient_over_distance(std::sqrt(x + y + z));
      }
    }
  }
  return weight;
}

}  // namespace

VectorView pair_weights(const NeighbourList& list, ConstPositionView positions, ConstIndexView targets,
                        const Kernel& kernel, double support, const std::optional<Box>& faces) {
  // Kernels are open to plugins, so that their values come through a virtual call: set-up work, done on the host.
  const HostPositions host_positions = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), positions);
  const auto host_targets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), targets);
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), list.offsets);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), list.neighbours);
  VectorView weights(Kokkos::view_alloc(Kokkos::WithoutInitializing, "pair weights"), neighbours.extent(0));
  const auto host_weights = Kokkos::create_mirror_view(weights);
  // As for neighbours: pairs exactly at the support are outside, whatever the rounding.
  const double squared_support = std::pow(support * (1.0 - 1e-10), 2);
  for (std::size_t t = 0; t < host_targets.extent(0); ++t) {
    for (std::size_t pair = offsets(t); pair < offsets(t + 1); ++pair) {
      const LocalIndex i = host_targets(t);
      const LocalIndex j = neighbours(pair);
      host_weights(pair) = faces ? mirrored_weight(host_positions, i, j, kernel, squared_support, *faces)
                                 : direct_weight(host_positions, i, j, kernel);
    }
  }
  Kokkos::deep_copy(weights, host_weights);
  return weights;
}

}  // namespace kiln
