#include <algorithm>
#include <string>
#include <vector>

#include "framework/base/ViewOf.hpp"
#include "physics/sph/LatticeBox.hpp"
#include "physics/sph/PairLayout.hpp"

namespace kiln {

#ifdef KILN_LANES
namespace {

/// Pairs that share a divide. Eight take 0.9 of the time of four.
constexpr LocalIndex shared = 8;

/// What the sweep reads: states in LatticeBox's order, 3 · lane_count numbers a vector (u, 1/k, V), and the stencil.
struct LatticeRows {
  static constexpr LocalIndex vector_length = 3 * lane_count;

  VectorView vectors;
  IndexView blocks;
  IndexView rows;       ///< of each lane of each block; none: not a row
  IndexView filled;     ///< vectors that hold sources
  IndexView sources;    ///< of each lane of each filled vector; where none is, the state after the last source's
  IndexView distances;  ///< in numbers, of each offset; their count is a multiple of `shared`
  VectorView weights;   ///< of each pair of opposite offsets

  KOKKOS_INLINE_FUNCTION void fill(const ThermalState<double>* states, LocalIndex n) const {
    const StateLanes lanes = state_lanes(states, &sources(n * lane_count));
    double* vector = &vectors(filled(n) * vector_length);
    store_lanes(vector, lanes.temperature);
    store_lanes(vector + lane_count, lanes.resistivity);
    store_lanes(vector + 2 * lane_count, lanes.volume);
  }

  template <PairQuantity quantity>
  KOKKOS_INLINE_FUNCTION void sweep(LocalIndex block, double* sums) const {
    const double* own = vectors.data() + blocks(block) * vector_length;
    const Lanes u_i = lanes_at(own);
    const Lanes resistivity_i = lanes_at(own + lane_count);
    const auto term = [&](LocalIndex distance) {
      const double* j = own + distance;
      return pair_term<quantity>(u_i, resistivity_i, lanes_at(j), lanes_at(j + lane_count),
                                 lanes_at(j + 2 * lane_count));
    };
    const auto opposite = [&](const LocalIndex* distance, double weight) {
      return (term(distance[0]) + term(distance[1])).weighted(weight);
    };
    const auto count = static_cast<LocalIndex>(distances.extent(0));
    const LocalIndex* d = distances.data();
    const double* w = weights.data();
    Lanes sum = {};
    for (LocalIndex n = 0; n < count; n += shared, d += shared, w += shared / 2) {
      sum += ((opposite(d, w[0]) + opposite(d + 2, w[1])) + (opposite(d + 4, w[2]) + opposite(d + 6, w[3]))).value();
    }
    for (LocalIndex lane = 0; lane < lane_count; ++lane) {
      const LocalIndex row = rows(block * lane_count + lane);
      if (row != LatticeBox::none) sums[row] = sum[lane];
    }
  }
};

template <PairQuantity quantity>
void sweep_blocks(const LatticeRows& lattice, const VectorView& sums) {
  Kokkos::parallel_for(
      "kiln::sph::lattice sweep", RangePolicy(0, static_cast<LocalIndex>(lattice.blocks.extent(0))),
      KOKKOS_LAMBDA(LocalIndex block) { lattice.sweep<quantity>(block, sums.data()); });
}

class LatticeSweep final : public PairLayout {
 public:
  LatticeSweep(const HeatDomain& domain, const LatticeBox& box) {
    const auto row_count = static_cast<LocalIndex>(domain.areas.extent(0));
    const auto source_count = static_cast<LocalIndex>(domain.masses.extent(0));
    const LatticeStencil& stencil = *domain.stencil;
    std::vector<LocalIndex> rows;
    for (const LocalIndex block : box.blocks) {
      for (int lane = 0; lane < lane_count; ++lane) {
        const LocalIndex source = box.sources[static_cast<std::size_t>(block) * lane_count + lane];
        rows.push_back(source < row_count ? source : LatticeBox::none);
      }
    }
    std::vector<LocalIndex> filled;
    std::vector<LocalIndex> sources;
    for (std::size_t first = 0; first < box.sources.size(); first += lane_count) {
      const auto lanes = box.sources.begin() + static_cast<std::ptrdiff_t>(first);
      if (std::all_of(lanes, lanes + lane_count, [](LocalIndex s) { return s == LatticeBox::none; })) continue;
      filled.push_back(static_cast<LocalIndex>(first / lane_count));
      for (int lane = 0; lane < lane_count; ++lane) {
        sources.push_back(lanes[lane] == LatticeBox::none ? source_count : lanes[lane]);
      }
    }
    std::vector<LocalIndex> distances;
    std::vector<double> weights;
    for (std::size_t n = 0; n < stencil.offsets.size(); ++n) {
      distances.push_back(box.distance(stencil.offsets[n]) * LatticeRows::vector_length);
      if (n % 2 == 0) weights.push_back(stencil.weights[n]);
    }
    while (distances.size() % shared != 0) distances.push_back(0);
    weights.resize(distances.size() / 2, 0.0);
    lattice_.blocks = view_of<IndexView>(box.blocks, "lattice blocks");
    lattice_.rows = view_of<IndexView>(rows, "lattice rows");
    lattice_.filled = view_of<IndexView>(filled, "filled vectors");
    lattice_.sources = view_of<IndexView>(sources, "lattice sources");
    lattice_.distances = view_of<IndexView>(distances, "stencil distances");
    lattice_.weights = view_of<VectorView>(weights, "stencil weights");
    std::vector<double> empty;
    for (std::size_t vector = 0; vector < box.sources.size() / lane_count; ++vector) {
      empty.insert(empty.end(), lane_count, nobody.temperature);
      empty.insert(empty.end(), lane_count, nobody.resistivity);
      empty.insert(empty.end(), lane_count, nobody.volume);
    }
    lattice_.vectors = view_of<VectorView>(empty, "lattice states");
    if (stencil.mirrored) own_images_ = sliced_rows(domain);
  }

  const char* name() const override { return "lattice sweep"; }
  std::size_t bytes() const override {
    return (lattice_.vectors.span() + lattice_.weights.span()) * sizeof(double) +
           (lattice_.blocks.span() + lattice_.rows.span() + lattice_.filled.span() + lattice_.sources.span() +
            lattice_.distances.span()) *
               sizeof(LocalIndex) +
           (own_images_ ? own_images_->bytes() : 0);
  }
  void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const override {
    // A particle's own image has its temperature always: nothing flows, but the stencil would count a conductance.
    if (quantity == PairQuantity::conductance && own_images_) return own_images_->sum(quantity, states, sums);
    const LatticeRows lattice = lattice_;
    Kokkos::parallel_for(
        "kiln::sph::fill lattice", RangePolicy(0, static_cast<LocalIndex>(lattice.filled.extent(0))),
        KOKKOS_LAMBDA(LocalIndex n) { lattice.fill(states.data(), n); });
    if (quantity == PairQuantity::flux) {
      sweep_blocks<PairQuantity::flux>(lattice, sums);
    } else {
      sweep_blocks<PairQuantity::conductance>(lattice, sums);
    }
  }

 private:
  LatticeRows lattice_;
  std::unique_ptr<PairLayout> own_images_;  ///< with mirrors: the listed pairs, which have none
};

}  // namespace

std::unique_ptr<PairLayout> lattice_sweep(const HeatDomain& domain) {
  constexpr bool on_host = Kokkos::SpaceAccessibility<Kokkos::HostSpace, Device::memory_space>::accessible;
  if (!on_host) return nullptr;
  const auto box = lattice_box(domain);
  return box ? std::make_unique<LatticeSweep>(domain, *box) : nullptr;
}
#else
std::unique_ptr<PairLayout> lattice_sweep(const HeatDomain&) { return nullptr; }
#endif

}  // namespace kiln
