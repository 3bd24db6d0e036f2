#include <string>

#include "framework/base/Loop.hpp"
#include "physics/sph/PairLayout.hpp"
#include "physics/sph/PairRows.hpp"

namespace kiln {
namespace {

#ifdef KILN_LANES
constexpr LocalIndex multiple = lane_count;
#else
constexpr LocalIndex multiple = 1;
#endif

// Made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string sum_label = "kiln::sph::sum compressed rows";

/// The domain's rows, each made up to a multiple of the lanes with pairs of no weight.
HeatDomain whole_lanes(const HeatDomain& domain) {
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.offsets);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.neighbours);
  const auto weights = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.weights);
  const std::size_t rows = domain.areas.extent(0);
  HeatDomain whole = domain;
  whole.pairs.offsets = OffsetView("row offsets", rows + 1);
  const auto whole_offsets = Kokkos::create_mirror_view(whole.pairs.offsets);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t count = offsets(i + 1) - offsets(i);
    whole_offsets(i + 1) = whole_offsets(i) + (count + multiple - 1) / multiple * multiple;
  }
  whole.pairs.neighbours = IndexView("row neighbours", whole_offsets(rows));
  whole.weights = VectorView("row weights", whole_offsets(rows));
  const auto whole_neighbours = Kokkos::create_mirror_view(whole.pairs.neighbours);
  const auto whole_weights = Kokkos::create_mirror_view(whole.weights);
  for (std::size_t i = 0; i < rows; ++i) {
    std::size_t at = whole_offsets(i);
    for (std::size_t pair = offsets(i); pair < offsets(i + 1); ++pair, ++at) {
      whole_neighbours(at) = neighbours(pair);
      whole_weights(at) = weights(pair);
    }
    for (; at < whole_offsets(i + 1); ++at) whole_neighbours(at) = static_cast<LocalIndex>(i);
  }
  Kokkos::deep_copy(whole.pairs.offsets, whole_offsets);
  Kokkos::deep_copy(whole.pairs.neighbours, whole_neighbours);
  Kokkos::deep_copy(whole.weights, whole_weights);
  return whole;
}

template <PairQuantity quantity>
void sum_rows(const PairRows& pairs, const ConstThermalStateView& of_sources, const VectorView& of_rows) {
  const auto states = borrowed(of_sources);
  const auto sums = borrowed(of_rows);
  loop(
      sum_label, static_cast<LocalIndex>(sums.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
#ifdef KILN_LANES
        sums(i) = pair_sum_by_lanes<quantity>(states.data(), states(i), pairs.sources_of(i), pairs.weights_of(i),
                                              pairs.count(i));
#else
        sums(i) =
            pair_sum<quantity>(states.data(), states(i), pairs.sources_of(i), pairs.weights_of(i), pairs.count(i));
#endif
      });
}

class CompressedRows final : public PairLayout {
 public:
  explicit CompressedRows(const HeatDomain& domain) : whole_(whole_lanes(domain)), pairs_(whole_) {}
  const char* name() const override { return "compressed rows"; }
  std::size_t bytes() const override {
    return pairs_.offsets.span() * sizeof(std::size_t) + pairs_.neighbours.span() * sizeof(LocalIndex) +
           pairs_.weights.span() * sizeof(double);
  }
  void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const override {
    if (quantity == PairQuantity::flux) {
      sum_rows<PairQuantity::flux>(pairs_, states, sums);
    } else {
      sum_rows<PairQuantity::conductance>(pairs_, states, sums);
    }
  }

 private:
  HeatDomain whole_;
  PairRows pairs_;  ///< of whole_
};

}  // namespace

std::unique_ptr<PairLayout> compressed_rows(const HeatDomain& domain) {
  return std::make_unique<CompressedRows>(domain);
}

std::unique_ptr<PairLayout> pair_layout(const HeatDomain& domain) {
  if (auto lattice = lattice_sweep(domain)) return lattice;
  return domain.mutual && ExecutionSpace().concurrency() == 1 ? half_list(domain) : compressed_rows(domain);
}

}  // namespace kiln
