#pragma once

#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {

/// Files hold one row a particle; reductions compute with one row a particle and component. A matrix of k columns over
/// particles × c components is folded into particles × (k · c): column k · c + j is component j of column k.
MatrixView fold(const MatrixView& entries, int components);
/// The inverse of fold().
MatrixView unfold(const MatrixView& particles, int components);

/// u_ref and [Φ_0 Φ_1 …] at some particles, × components.
struct BasisRows {
  VectorView reference;
  MatrixView modes;
};

/// Some particles with all that reduced methods need of them, the same on every rank.
struct ParticleTable {
  std::vector<GlobalIndex> ids;  ///< ascending
  int components = 1;
  std::vector<double> positions;  ///< x, y, z of one particle after the other, in m
  hdf5::Array<double> reference;  ///< ids × components
  hdf5::Array<double> modes;      ///< ids × (M · components), folded

  /// From distributed data: rows of `map`, each particle on one rank. `ids` ascending; `modes`: those of one time
  /// window after the other, which come to stand side by side. Collective.
  static ParticleTable gather(const std::vector<GlobalIndex>& ids, const Map& map, ConstPositionView positions,
                              const VectorView& reference, const std::vector<MatrixView>& modes, int components);
  /// Datasets ids, positions, reference and modes of a group.
  void write(hdf5::Group& group) const;
  /// `ids` are the particles of the group, checked.
  static ParticleTable read(const hdf5::Group& group, std::vector<GlobalIndex> ids, int components, int modes);

  /// Entries of the particles, × components, as reductions compute with them: unfolded.
  VectorView reference_entries() const;
  MatrixView mode_entries() const;

  /// Place of a particle in the table; −1 if it is not there.
  std::ptrdiff_t find(GlobalIndex id) const;
};

/// The rows of tables at the particles of a map, each in the first table that has it, and of the modes the first
/// `columns`. Throws FileError naming `file`, which the tables are from, for a particle they lack. Collective over the
/// map's ranks.
BasisRows rows_at(const Map& particles, const std::vector<const ParticleTable*>& tables, std::size_t columns,
                  const std::string& file);

}  // namespace kiln
