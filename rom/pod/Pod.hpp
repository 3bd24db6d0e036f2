#pragma once

#include "rom/pod/Snapshots.hpp"
#include "rom/pod/Truncation.hpp"

namespace kiln {

/// A proper orthogonal decomposition of snapshots S ≈ Φ Σ Vᵀ (Eq. 22), truncated.
struct Pod {
  MatrixView modes;                     ///< Φ: this rank's rows × rank, orthonormal over all ranks
  std::vector<double> singular_values;  ///< descending; all of S, or what a randomised one has seen of them
  Truncation truncation;
  std::size_t snapshots = 0;      ///< that it is of
  double orthogonality = 0.0;     ///< largest entry of |ΦᵀΦ − I|
  bool reorthogonalised = false;  ///< whether Φ had lost more orthogonality than 1e-10 and was orthonormalised again
};

/// Collective over the ranks that hold the snapshots' rows. `tsqr` overwrites the snapshots; `gram` and `randomised`
/// leave them. Signs are those that make the largest entry of each right singular vector positive, so that they do not
/// depend on the number of ranks. Throws InputError as truncate() does.
Pod pod(const Snapshots& snapshots, const PodSettings& settings, const Communicator& communicator);

}  // namespace kiln
