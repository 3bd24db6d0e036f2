#pragma once

#include <optional>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A table of properties whose rows are those of few polynomials of degree two, to round-off, as of a material given by
/// formulas of temperature: a handful of coefficients stays in the first cache, where the table's 371 KiB do not.
///
/// Between two rows j and j + 1 of a piece, counted from its first one, a property is what a table says, the straight
/// line: a + b x + c (x² + f − f²) at x = j + f.
struct alignas(64) MaterialPieces {
  /// As many as a vector has lanes, so that looking one up is a permutation of a vector.
  static constexpr int most = 8;
  using Coefficients = double[most];

  /// The piece that the interval of `place` belongs to: the last one that begins at or below it.
  KOKKOS_FORCEINLINE_FUNCTION int piece_at(double place) const {
    int piece = 0;
    for (int k = 1; k < most; ++k) piece += place >= starts[k] ? 1 : 0;
    return piece;
  }

  Coefficients starts;      ///< the first row of each, as a number; infinity where there is none
  Coefficients values[3];   ///< a of conductivity, specific heat and density
  Coefficients firsts[3];   ///< b
  Coefficients seconds[3];  ///< c

  /// Of rows of conductivity, specific heat and density, one after the other; none where it takes more than `most`. The
  /// last row is a piece of its own.
  static std::optional<MaterialPieces> of(const std::vector<double>& rows);
};

}  // namespace kiln
