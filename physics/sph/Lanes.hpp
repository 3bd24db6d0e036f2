#pragma once

#include "physics/sph/ThermalState.hpp"

/// Eight numbers at once, as vectors of GCC and Clang: the compiler splits them into what the processor has. Defined
/// for the host only; code for other execution spaces goes number by number.
#if defined(__GNUC__) && !defined(__CUDA_ARCH__) && !defined(__HIP_DEVICE_COMPILE__)
#define KILN_LANES
// Vectors wider than the processor's pass between inlined functions only: how a call would pass them is no concern.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace kiln {

inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
using HalfLanes = double __attribute__((vector_size(lane_count / 2 * sizeof(double))));
static_assert(sizeof(ThermalState<double>) == sizeof(HalfLanes));

inline Lanes lanes_at(const double* numbers) {
  Lanes lanes;
  __builtin_memcpy(&lanes, numbers, sizeof lanes);
  return lanes;
}

inline void store_lanes(double* numbers, const Lanes& lanes) { __builtin_memcpy(numbers, &lanes, sizeof lanes); }

inline Lanes all_lanes(double x) { return Lanes{x, x, x, x, x, x, x, x}; }

inline double lane_sum(const Lanes& x) { return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])); }

/// The states of eight particles, field by field.
struct StateLanes {
  Lanes temperature;
  Lanes resistivity;
  Lanes volume;
};

/// The first three fields of eight records of four numbers, transposed in registers.
struct FieldLanes {
  Lanes first;
  Lanes second;
  Lanes third;
};
inline FieldLanes field_lanes(const HalfLanes (&records)[lane_count]) {
  // Record k in the lower half, record k + 4 in the upper one.
  Lanes two[4];
  for (int k = 0; k < 4; ++k) two[k] = __builtin_shufflevector(records[k], records[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes even01 = __builtin_shufflevector(two[0], two[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes even23 = __builtin_shufflevector(two[2], two[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes odd01 = __builtin_shufflevector(two[0], two[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes odd23 = __builtin_shufflevector(two[2], two[3], 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(even01, even23, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(odd01, odd23, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(even01, even23, 2, 3, 10, 11, 6, 7, 14, 15)};
}

/// Loads whole states: two thirds of the time of gathering field by field.
inline StateLanes state_lanes(const ThermalState<double>* states, const LocalIndex* indices) {
  HalfLanes whole[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) {
    __builtin_memcpy(&whole[lane], &states[indices[lane]], sizeof whole[lane]);
  }
  const FieldLanes fields = field_lanes(whole);
  return {fields.first, fields.second, fields.third};
}

}  // namespace kiln
#endif
