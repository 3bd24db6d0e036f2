#include <algorithm>
#include <vector>

#include "physics/sph/PairLayout.hpp"
#include "physics/sph/PairRows.hpp"

namespace kiln {
namespace {

/// Pairs (i, j) of a row i with j > i: rows that come later, and sources that are no rows. What goes to the latter is
/// summed up as well and left unread. Needs rows to be summed one after the other.
struct HalfRows {
  OffsetView offsets;
  IndexView neighbours;
  VectorView weights;
  VectorView totals;  ///< of the sources

  template <PairQuantity quantity>
  KOKKOS_INLINE_FUNCTION void add_row(const ThermalState<double>* states, LocalIndex row) const {
    // The flux changes its sign with the direction of a pair, the conductance does not.
    constexpr double sign = quantity == PairQuantity::flux ? -1.0 : 1.0;
    const ThermalState<double> i = states[row];
    const LocalIndex* sources = neighbours.data() + offsets(row);
    const double* weight = weights.data() + offsets(row);
    const auto count = static_cast<LocalIndex>(offsets(row + 1) - offsets(row));
    double* total = totals.data();
    double sum = 0.0;
    LocalIndex pair = 0;
#ifdef KILN_LANES
    const Lanes u_i = all_lanes(i.temperature);
    const Lanes resistivity_i = all_lanes(i.resistivity);
    const Lanes one = all_lanes(1.0);
    Lanes sums = {};
    for (; pair + lane_count <= count; pair += lane_count) {
      __builtin_prefetch(weight + pair + 512);
      __builtin_prefetch(sources + pair + 1024);
      const StateLanes j = state_lanes(states, sources + pair);
      const Lanes shared = pair_term<quantity>(u_i, resistivity_i, j.temperature, j.resistivity, one)
                               .weighted(lanes_at(weight + pair))
                               .value();
      sums += j.volume * shared;
      const Lanes back = sign * i.volume * shared;
      for (int lane = 0; lane < lane_count; ++lane) total[sources[pair + lane]] += back[lane];
    }
    sum = lane_sum(sums);
#endif
    for (; pair < count; ++pair) {
      const ThermalState<double>& j = states[sources[pair]];
      const double shared =
          weight[pair] * pair_term<quantity>(i.temperature, i.resistivity, j.temperature, j.resistivity, 1.0).value();
      sum += j.volume * shared;
      total[sources[pair]] += sign * i.volume * shared;
    }
    total[row] += sum;
  }
};

template <PairQuantity quantity>
void sum_half(const HalfRows& half, const ConstThermalStateView& states, const VectorView& sums) {
  Kokkos::deep_copy(ExecutionSpace(), half.totals, 0.0);
  const auto rows = static_cast<LocalIndex>(sums.extent(0));
  Kokkos::parallel_for(
      "kiln::sph::sum half list", RangePolicy(0, rows),
      KOKKOS_LAMBDA(LocalIndex i) { half.add_row<quantity>(states.data(), i); });
  Kokkos::parallel_for(
      "kiln::sph::take half list", RangePolicy(0, rows), KOKKOS_LAMBDA(LocalIndex i) { sums(i) = half.totals(i); });
}

class HalfList final : public PairLayout {
 public:
  explicit HalfList(const HeatDomain& domain) {
    const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.offsets);
    const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.neighbours);
    const auto weights = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.weights);
    const auto rows = static_cast<LocalIndex>(domain.areas.extent(0));
    half_.offsets = OffsetView("half offsets", rows + 1);
    const auto half_offsets = Kokkos::create_mirror_view(half_.offsets);
    std::size_t kept = 0;
    for (LocalIndex i = 0; i < rows; ++i) {
      for (std::size_t pair = offsets(i); pair < offsets(i + 1); ++pair) kept += neighbours(pair) > i ? 1 : 0;
      half_offsets(i + 1) = kept;
    }
    half_.neighbours = IndexView(Kokkos::view_alloc(Kokkos::WithoutInitializing, "half neighbours"), kept);
    half_.weights = VectorView(Kokkos::view_alloc(Kokkos::WithoutInitializing, "half weights"), kept);
    half_.totals = VectorView("totals", domain.masses.extent(0));
    const auto half_neighbours = Kokkos::create_mirror_view(half_.neighbours);
    const auto half_weights = Kokkos::create_mirror_view(half_.weights);
    std::size_t at = 0;
    for (LocalIndex i = 0; i < rows; ++i) {
      for (std::size_t pair = offsets(i); pair < offsets(i + 1); ++pair) {
        if (neighbours(pair) <= i) continue;
        half_neighbours(at) = neighbours(pair);
        half_weights(at++) = weights(pair);
      }
    }
    Kokkos::deep_copy(half_.offsets, half_offsets);
    Kokkos::deep_copy(half_.neighbours, half_neighbours);
    Kokkos::deep_copy(half_.weights, half_weights);
  }

  const char* name() const override { return "half list"; }
  std::size_t bytes() const override {
    return half_.offsets.span() * sizeof(std::size_t) + half_.neighbours.span() * sizeof(LocalIndex) +
           (half_.weights.span() + half_.totals.span()) * sizeof(double);
  }
  void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const override {
    if (quantity == PairQuantity::flux) {
      sum_half<PairQuantity::flux>(half_, states, sums);
    } else {
      sum_half<PairQuantity::conductance>(half_, states, sums);
    }
  }

 private:
  HalfRows half_;
};

}  // namespace

std::unique_ptr<PairLayout> half_list(const HeatDomain& domain) { return std::make_unique<HalfList>(domain); }

}  // namespace kiln
