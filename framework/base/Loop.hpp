#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Calls body(i) for i = 0 … count − 1 in parallel: Kokkos::parallel_for for loops that may be as short as a sample
/// mesh. On the serial execution space a dispatch (locks, copies, hooks of tools) costs as much as some hundred pairs;
/// there the loop runs right here, unless a Kokkos tool is loaded, which then sees every kernel under its label.
template <class Body>
void loop(const std::string& label, LocalIndex count, const Body& body) {
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>) {
    // Tools are loaded when Kokkos starts, and stay.
    static const bool heard = Kokkos::Tools::profileLibraryLoaded();
    if (!heard) {
      for (LocalIndex i = 0; i < count; ++i) body(i);
      return;
    }
  }
#endif
  Kokkos::parallel_for(label, RangePolicy(0, count), body);
}

/// Σ body(i) for i = 0 … count − 1 in parallel, in the same order each time. On the serial execution space it runs
/// right here in several partial sums side by side: in one, each addition waits for the one before, nine cycles a
/// number.
template <class Body>
double sum(const std::string& label, LocalIndex count, const Body& body) {
  double total = 0.0;
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>) {
    // A tool hears of the kernel, and the bits of the sum stay the same.
    std::uint64_t kernel = 0;
    static const bool heard = Kokkos::Tools::profileLibraryLoaded();
    if (heard) Kokkos::Tools::beginParallelReduce(label, 0, &kernel);
#pragma omp simd reduction(+ : total)
    for (LocalIndex i = 0; i < count; ++i) total += body(i);
    if (heard) Kokkos::Tools::endParallelReduce(kernel);
    return total;
  }
#endif
  Kokkos::parallel_reduce(
      label, RangePolicy(0, count), KOKKOS_LAMBDA(const LocalIndex i, double& part) { part += body(i); }, total);
  return total;
}

/// Whether a and b, of equal lengths, hold the same numbers; zeros of different sign need not count as the same.
inline bool same_values(const ConstVectorView& a, const ConstVectorView& b) {
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>) {
    return std::memcmp(a.data(), b.data(), a.extent(0) * sizeof(double)) == 0;
  }
#endif
  LocalIndex different = 0;
  Kokkos::parallel_reduce(
      "kiln::same values", RangePolicy(0, static_cast<LocalIndex>(a.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i, LocalIndex& count) { count += a(i) == b(i) ? 0 : 1; }, different);
  return different == 0;
}

/// to(i) = from(i), of equal lengths. Unlike Kokkos::deep_copy it waits for nothing.
inline void copy_values(const ConstVectorView& from, const VectorView& to) {
  static const std::string label = "kiln::copy values";
  const auto source = borrowed(from);
  const auto target = borrowed(to);
  loop(
      label, static_cast<LocalIndex>(to.extent(0)), KOKKOS_LAMBDA(const LocalIndex i) { target(i) = source(i); });
}

/// Brings values to their host mirror, of Kokkos::create_mirror_view. Where the mirror is the array itself, nothing is
/// to be done; Kokkos::deep_copy would wait for all kernels nonetheless.
inline void copy_to_host(const VectorView& from, const VectorView::HostMirror& to) {
  if (to.data() != from.data()) Kokkos::deep_copy(to, from);
}

}  // namespace kiln
