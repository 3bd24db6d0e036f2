#include "physics/sph/PairLayout.hpp"
#include "physics/sph/PairRows.hpp"

namespace kiln {
namespace {

template <PairQuantity quantity>
void sum_rows(const PairRows& pairs, const ConstThermalStateView& states, const VectorView& sums) {
  Kokkos::parallel_for(
      "kiln::sph::sum compressed rows", RangePolicy(0, static_cast<LocalIndex>(sums.extent(0))),
      KOKKOS_LAMBDA(LocalIndex i) {
        sums(i) =
            pair_sum<quantity>(states.data(), states(i), pairs.sources_of(i), pairs.weights_of(i), pairs.count(i));
      });
}

class CompressedRows final : public PairLayout {
 public:
  explicit CompressedRows(const HeatDomain& domain) : pairs_(domain) {}
  const char* name() const override { return "compressed rows"; }
  std::size_t bytes() const override { return 0; }
  void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const override {
    if (quantity == PairQuantity::flux) {
      sum_rows<PairQuantity::flux>(pairs_, states, sums);
    } else {
      sum_rows<PairQuantity::conductance>(pairs_, states, sums);
    }
  }

 private:
  PairRows pairs_;
};

}  // namespace

std::unique_ptr<PairLayout> compressed_rows(const HeatDomain& domain) {
  return std::make_unique<CompressedRows>(domain);
}

std::unique_ptr<PairLayout> pair_layout(const HeatDomain& domain) {
  if (auto lattice = lattice_sweep(domain)) return lattice;
  // A sample mesh has few pairs between its own rows; listing those once would save nothing.
  const auto rows = static_cast<LocalIndex>(domain.areas.extent(0));
  const ConstIndexView neighbours = domain.pairs.neighbours;
  std::size_t own = 0;
  Kokkos::parallel_reduce(
      "kiln::sph::count pairs of rows", Kokkos::RangePolicy<ExecutionSpace>(0, neighbours.extent(0)),
      KOKKOS_LAMBDA(std::size_t pair, std::size_t & count) { count += neighbours(pair) < rows ? 1 : 0; }, own);
  const bool mostly_own = 2 * own > neighbours.extent(0);
  return mostly_own && ExecutionSpace().concurrency() == 1 ? half_list(domain) : compressed_rows(domain);
}

}  // namespace kiln
