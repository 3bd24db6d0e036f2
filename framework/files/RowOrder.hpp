#pragma once

#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The order in which the particles of a distributed map stand in a file: by ascending global id, whatever the number
/// of ranks. The rows are cut into slabs of nearly equal length, one a rank, so that each rank writes one piece.
class RowOrder {
 public:
  /// Collective. Throws std::logic_error if a particle lies on more than one rank.
  explicit RowOrder(const Map& map);

  std::size_t rows() const;                          ///< over all ranks
  std::size_t first() const { return first_; }       ///< of this rank's slab
  std::size_t count() const { return ids_.size(); }  ///< of this rank's slab
  /// Global ids of this rank's slab, ascending.
  const std::vector<long long>& ids() const { return ids_; }
  /// This rank's slab, row by row. values: local particles × columns, in the map's order. Collective.
  std::vector<double> slab(ConstMatrixView values) const;

 private:
  Teuchos::RCP<const Map> particles_;  ///< each local particle's row
  Teuchos::RCP<const Map> slabs_;
  Teuchos::RCP<const Import> import_;
  std::size_t first_ = 0;
  std::vector<long long> ids_;
};

/// The inverse for reading: what the particles of `map` find in a dataset whose row i belongs to global id i. `slab` is
/// this rank's slab of it, row by row, cut as slab_map(rows) cuts it. Collective.
MatrixView spread_slabs(const std::vector<double>& slab, std::size_t rows, std::size_t columns, const Map& map);
Teuchos::RCP<const Map> slab_map(std::size_t rows, const Map& map);

}  // namespace kiln
