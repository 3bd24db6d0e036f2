#pragma once

#include <Kokkos_Core.hpp>

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/MaterialTable.hpp"

namespace kiln {

/// What a pair reads of one particle, in one piece of memory. Written for any scalar type, so that automatic
/// differentiation (Sacado) and complex steps go through the very code that runs.
template <class Scalar>
struct alignas(32) ThermalState {
  Scalar temperature;    ///< u in K
  Scalar resistivity;    ///< 1/k in m K/W
  Scalar volume;         ///< V = m/ρ(u) in m³
  Scalar specific_heat;  ///< c in J/(kg K)
};

using ThermalStateView = Kokkos::View<ThermalState<double>*, Device>;
using ConstThermalStateView = Kokkos::View<const ThermalState<double>*, Device>;

/// The state at temperature u (K) of a particle of the given mass (kg).
template <class Scalar>
KOKKOS_INLINE_FUNCTION ThermalState<Scalar> thermal_state(const MaterialLookup& table, const Scalar& temperature,
                                                          double mass) {
  const MaterialPoint<Scalar> point = table.at(temperature);
  // One divide for 1/k and m/ρ: half of the time goes into dividing.
  const Scalar both = 1.0 / (point.conductivity * point.density);
  return {temperature, both * point.density, mass * (both * point.conductivity), point.specific_heat};
}

}  // namespace kiln
