#include <algorithm>
#include <string>

#include "framework/base/Loop.hpp"
#include "physics/sph/PairLayout.hpp"

namespace kiln {
namespace {

// Made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string sum_label = "kiln::sph::sum sliced rows";

/// Rows in slices of as many as go through the pairs together, each made up to the longest of its slice with pairs of
/// no weight (sliced ELLPACK: Monakov, Lokhmotov, Avetisyan 2010).
class SlicedRows final : public PairLayout {
 public:
  explicit SlicedRows(const HeatDomain& domain)
      : slices_((domain.areas.extent(0) + height - 1) / height),
        offsets_("slice offsets", slices_ + 1),
        rows_("rows of slices", slices_ * height) {
    const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.offsets);
    const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.neighbours);
    const auto weights = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.weights);
    const std::size_t rows = domain.areas.extent(0);
    const auto count = [&](std::size_t row) { return row < rows ? offsets(row + 1) - offsets(row) : 0; };
    const auto slice_offsets = Kokkos::create_mirror_view(offsets_);
    for (std::size_t slice = 0; slice < slices_; ++slice) {
      std::size_t longest = 0;
      for (std::size_t lane = 0; lane < height; ++lane) longest = std::max(longest, count(slice * height + lane));
      slice_offsets(slice + 1) = slice_offsets(slice) + (longest + multiple - 1) / multiple * multiple;
    }
    sources_ = IndexView("sources of slices", slice_offsets(slices_) * height);
    weights_ = VectorView("weights of slices", slice_offsets(slices_) * height);
    const auto own = Kokkos::create_mirror_view(rows_);
    const auto slice_sources = Kokkos::create_mirror_view(sources_);
    const auto slice_weights = Kokkos::create_mirror_view(weights_);
    const auto no_row = static_cast<LocalIndex>(domain.masses.extent(0));
    for (std::size_t row = 0; row < slices_ * height; ++row) {
      const std::size_t slice = row / height, lane = row % height;
      own(row) = row < rows ? static_cast<LocalIndex>(row) : no_row;
      for (std::size_t pair = 0; pair < slice_offsets(slice + 1) - slice_offsets(slice); ++pair) {
        const std::size_t at = (slice_offsets(slice) + pair) * height + lane;
        const bool given = pair < count(row);
        slice_sources(at) = given ? neighbours(offsets(row) + pair) : own(row);
        slice_weights(at) = given ? weights(offsets(row) + pair) : 0.0;
      }
    }
    Kokkos::deep_copy(offsets_, slice_offsets);
    Kokkos::deep_copy(rows_, own);
    Kokkos::deep_copy(sources_, slice_sources);
    Kokkos::deep_copy(weights_, slice_weights);
  }

  const char* name() const override { return "sliced rows"; }
  std::size_t bytes() const override {
    return offsets_.span() * sizeof(std::size_t) + (rows_.span() + sources_.span()) * sizeof(LocalIndex) +
           weights_.span() * sizeof(double);
  }
  void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const override {
    if (quantity == PairQuantity::flux) {
      sum<PairQuantity::flux>(states, sums);
    } else {
      sum<PairQuantity::conductance>(states, sums);
    }
  }

 private:
#ifdef KILN_LANES
  static constexpr std::size_t height = lane_count;
  static constexpr std::size_t multiple = pairs_that_share;
#else
  static constexpr std::size_t height = 1;
  static constexpr std::size_t multiple = 1;
#endif

  template <PairQuantity quantity>
  void sum(const ConstThermalStateView& of_sources, const VectorView& of_rows) const {
    const auto states = borrowed(of_sources);
    const auto sums = borrowed(of_rows);
    const auto offsets = borrowed(offsets_);
    const auto rows = borrowed(rows_);
    const auto sources = borrowed(sources_);
    const auto weights = borrowed(weights_);
    loop(
        sum_label, static_cast<LocalIndex>(slices_), KOKKOS_LAMBDA(LocalIndex slice) {
          const auto first = static_cast<LocalIndex>(slice * height);
          const auto count = static_cast<LocalIndex>(offsets(slice + 1) - offsets(slice));
          const LocalIndex* const slice_sources = sources.data() + offsets(slice) * height;
          const double* const slice_weights = weights.data() + offsets(slice) * height;
#ifdef KILN_LANES
          const Lanes sum = pair_sum_of_rows<quantity>(states.data(), state_lanes(states.data(), &rows(first)),
                                                       slice_sources, slice_weights, count);
          const auto left = static_cast<LocalIndex>(sums.extent(0)) - first;
          if (left >= lane_count) return store_lanes(&sums(first), sum);
          for (LocalIndex lane = 0; lane < left; ++lane) sums(first + lane) = sum[lane];
#else
          sums(first) = pair_sum<quantity>(states.data(), states(first), slice_sources, slice_weights, count);
#endif
        });
  }

  std::size_t slices_;
  OffsetView offsets_;  ///< first pair of each slice, of those of a single row
  IndexView rows_;      ///< of each slice; behind the last row `nobody`
  // Slice by slice, pair by pair, row by row.
  IndexView sources_;
  VectorView weights_;
};

}  // namespace

std::unique_ptr<PairLayout> sliced_rows(const HeatDomain& domain) { return std::make_unique<SlicedRows>(domain); }

std::unique_ptr<PairLayout> pair_layout(const HeatDomain& domain) {
  if (auto lattice = lattice_sweep(domain)) return lattice;
  return domain.mutual && ExecutionSpace().concurrency() == 1 ? half_list(domain) : sliced_rows(domain);
}

}  // namespace kiln
