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

/// Lanes where numbers lie, at any of them. Unlike a copy of bytes, a store of these does not make the compiler read
/// pointers anew, since it can only have changed numbers.
using LanesInPlace = double __attribute__((vector_size(lane_count * sizeof(double)), aligned(alignof(double))));

inline Lanes lanes_at(const double* numbers) { return *reinterpret_cast<const LanesInPlace*>(numbers); }

inline void store_lanes(double* numbers, const Lanes& lanes) { *reinterpret_cast<LanesInPlace*>(numbers) = lanes; }

inline Lanes all_lanes(double x) { return Lanes{x, x, x, x, x, x, x, x}; }

/// The largest whole numbers not above x, of 0 ≤ x < 2^51.
inline Lanes whole_part(const Lanes& x) {
  // Adding 2^52 leaves no room for a fraction: the nearest whole number.
  constexpr double rounder = 4503599627370496.0;
  const Lanes nearest = (x + rounder) - rounder;
  return nearest > x ? nearest - 1.0 : nearest;
}

using LaneBits = long long __attribute__((vector_size(lane_count * sizeof(long long))));

/// values[which[lane]] of each lane, from eight values.
inline Lanes picked(const double* values, const LaneBits& which) {
#ifdef __clang__
  Lanes lanes;
  for (int lane = 0; lane < lane_count; ++lane) lanes[lane] = values[which[lane]];
  return lanes;
#else
  return __builtin_shuffle(lanes_at(values), which);
#endif
}

/// The first and the second of each three numbers, of eight triples one after the other.
struct FirstTwoLanes {
  Lanes first;
  Lanes second;
};
inline FirstTwoLanes first_two_of_triples(const double* triples) {
  const Lanes a = lanes_at(triples), b = lanes_at(triples + lane_count), c = lanes_at(triples + 2 * lane_count);
  const Lanes first = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0);
  const Lanes second = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0);
  return {__builtin_shufflevector(first, c, 0, 1, 2, 3, 4, 5, 10, 13),
          __builtin_shufflevector(second, c, 0, 1, 2, 3, 4, 8, 11, 14)};
}

/// Whether any of eight numbers differs from its counterpart in a bit.
inline LaneBits differing_bits(const Lanes& a, const Lanes& b) {
  return reinterpret_cast<const LaneBits&>(a) ^ reinterpret_cast<const LaneBits&>(b);
}
inline bool any_bit(const LaneBits& x) {
  return (((x[0] | x[4]) | (x[2] | x[6])) | ((x[1] | x[5]) | (x[3] | x[7]))) != 0;
}

inline double lane_sum(const Lanes& x) { return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])); }

}  // namespace kiln
#endif
