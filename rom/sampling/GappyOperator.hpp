#pragma once

#include <string>

#include "rom/linear_algebra/Dense.hpp"

namespace kiln {

/// A = [PΦ_r]⁺, which tells the coordinates of a residual in Φ_r from its values at the sampled rows.
struct GappyOperator {
  MatrixView matrix;               ///< residual modes × sampled rows
  double smallest_singular_value;  ///< σ_min(PΦ_r); ‖A‖₂ = 1/σ_min bounds how much A amplifies what Φ_r misses
  double condition;                ///< σ_max/σ_min
};

/// sampled_modes: PΦ_r, sampled rows × residual modes, the same on every rank. Throws std::logic_error for fewer rows
/// than modes and InputError naming `path` where σ_min is zero to round-off.
GappyOperator gappy_operator(const ConstMatrixView& sampled_modes, const std::string& path);

}  // namespace kiln
