#pragma once

#include <functional>

namespace kiln::bench {

/// Work that shows a limit of one core. Each call moves or computes `amount` units.
struct Limit {
  std::function<void()> work;
  double amount;
};

/// a = b + 3 c over arrays of 256 MiB each; amount in bytes, 24 a number.
Limit stream_triad();

/// Floating-point operations that a pair's term needs: a difference, a sum, two products, a quotient and an addition.
inline constexpr double operations_per_pair = 6.0;

/// The pair term over 512 contiguous pairs in the first cache, as the compiler's vectors make it, one divide a pair;
/// amount in operations.
Limit pair_mix();

/// The same with one divide for eight pairs, as the lattice's kernel shares it; amount in the same operations, so that
/// what sharing costs is not counted as work done.
Limit shared_pair_mix();

}  // namespace kiln::bench
