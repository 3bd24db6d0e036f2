#pragma once

#include <memory>

#include "physics/sph/HeatDomain.hpp"
#include "physics/sph/PairSum.hpp"

namespace kiln {

/// How the pairs of a domain lie in memory, and with it how fast Eq. 7's sums are: the one thing a full evaluation
/// spends its time on. All layouts give the same sums to round-off.
class PairLayout {
 public:
  virtual ~PairLayout() = default;
  virtual const char* name() const = 0;
  /// Σ_j of a quantity for each row. states: one a source and, last, `nobody`; sums: rows, overwritten.
  virtual void sum(PairQuantity quantity, ConstThermalStateView states, VectorView sums) const = 0;
  /// Bytes of memory that the layout adds to the domain's.
  virtual std::size_t bytes() const = 0;
};

/// The state of a place where no particle is: its terms are 0.
inline constexpr ThermalState<double> nobody = {0.0, 1.0, 0.0, 1.0};

/// The fastest layout for these particles on this execution space.
std::unique_ptr<PairLayout> pair_layout(const HeatDomain& domain);

/// Some rows at a time, pair by pair, as many as a vector has lanes: for any particles, any rows, and any execution
/// space. A row's sum does not depend on the rows beside it.
std::unique_ptr<PairLayout> sliced_rows(const HeatDomain& domain);

/// Each pair of two rows once, for both of them: half of the memory to read. For domains whose pairs are mutual, and
/// where rows are summed one after the other only (one thread of a host).
std::unique_ptr<PairLayout> half_list(const HeatDomain& domain);

/// One stencil for all rows, when the domain's particles stand on a lattice: no neighbours and no weights are read.
/// Null when they do not, when one of the pairs does not fit the stencil, or off the host.
std::unique_ptr<PairLayout> lattice_sweep(const HeatDomain& domain);

}  // namespace kiln
