#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/HeatDomain.hpp"

namespace kiln {

/// The pairs of a domain row by row, for kernels to capture while the domain lives.
struct PairRows {
  explicit PairRows(const HeatDomain& domain)
      : offsets(domain.pairs.offsets), neighbours(domain.pairs.neighbours), weights(domain.weights) {}

  KOKKOS_FORCEINLINE_FUNCTION std::size_t first(LocalIndex row) const { return offsets(row); }
  KOKKOS_FORCEINLINE_FUNCTION LocalIndex count(LocalIndex row) const {
    return static_cast<LocalIndex>(offsets(row + 1) - offsets(row));
  }
  KOKKOS_FORCEINLINE_FUNCTION const LocalIndex* sources_of(LocalIndex row) const {
    return neighbours.data() + offsets(row);
  }
  KOKKOS_FORCEINLINE_FUNCTION const double* weights_of(LocalIndex row) const { return weights.data() + offsets(row); }

  decltype(borrowed(ConstOffsetView())) offsets;
  decltype(borrowed(ConstIndexView())) neighbours;
  decltype(borrowed(ConstVectorView())) weights;
};

}  // namespace kiln
