#pragma once

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

inline Lanes lanes_at(const double* numbers) {
  Lanes lanes;
  __builtin_memcpy(&lanes, numbers, sizeof lanes);
  return lanes;
}

inline void store_lanes(double* numbers, const Lanes& lanes) { __builtin_memcpy(numbers, &lanes, sizeof lanes); }

inline Lanes all_lanes(double x) { return Lanes{x, x, x, x, x, x, x, x}; }

inline double lane_sum(const Lanes& x) { return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])); }

}  // namespace kiln
#endif
