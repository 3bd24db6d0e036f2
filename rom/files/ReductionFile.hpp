#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>
#include <memory>

#include "framework/files/Hdf5.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/files/ParticleRows.hpp"

namespace kiln {

/// What a hyper-reduced run reads: nothing in it grows with the number of particles N of the full model.
struct SampleMesh {
  std::vector<GlobalIndex> rows;  ///< sampled particles, ascending
  ParticleTable sources;
  ParticleTable queries;
  hdf5::Array<double> gappy_operator;  ///< residual modes × (rows × components)
  double sigma_min;
  double condition;
};

/// A reduction file (layout: Reduction.hpp), opened for an online run.
class ReductionFile {
 public:
  /// The file the block `method` names, or reduction.h5 in `output.directory`.
  static std::filesystem::path path(const Teuchos::ParameterList& input);

  /// Opens the file of a run and checks that it belongs to the input's model. Throws FileError. Collective.
  ReductionFile(const Teuchos::ParameterList& input, const Teuchos::RCP<const Communicator>& communicator);

  /// Throws FileError unless time step and scheme of the input are those of the training.
  void require_time(const Teuchos::ParameterList& input) const;

  const hdf5::Group& root() const { return file_; }
  int components() const { return components_; }
  int basis_rank() const { return basis_rank_; }
  int residual_rank() const;
  long long particles() const { return particles_; }

  /// The basis on the particles of a map, read from the full one.
  std::unique_ptr<AffineBasis> basis(const Map& particles) const;
  SampleMesh sample_mesh() const;
  /// The group Model::save_sample wrote.
  hdf5::Group sample_model() const;

 private:
  hdf5::Group window() const;
  hdf5::File file_;
  int components_;
  int basis_rank_;
  long long particles_;
};

/// An affine basis on chosen particles of one or more tables; a particle is taken from the first table that has it.
/// Throws FileError naming `file` for a particle in none of them. Collective over the map's ranks.
std::unique_ptr<AffineBasis> basis_at(const Map& particles, const std::vector<const ParticleTable*>& tables,
                                      const std::string& file);

}  // namespace kiln
