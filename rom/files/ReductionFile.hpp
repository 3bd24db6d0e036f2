#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "framework/files/Hdf5.hpp"
#include "rom/basis/TimeWindow.hpp"
#include "rom/files/ParticleRows.hpp"
#include "rom/files/Questions.hpp"
#include "rom/files/TrainedRange.hpp"

namespace kiln {

/// What a hyper-reduced run reads of one time window: nothing in it grows with the number of particles N of the full
/// model.
struct SampleMesh {
  std::vector<GlobalIndex> rows;       ///< sampled particles, ascending
  std::vector<GlobalIndex> sources;    ///< likewise
  hdf5::Array<double> gappy_operator;  ///< residual modes × (rows × components)
  double sigma_min;
  double condition;
};

/// A reduction file (layout: Reduction.hpp), opened for an online run.
class ReductionFile {
 public:
  /// The file the block `method` names, or reduction.h5 in `output.directory`.
  static std::filesystem::path path(const Teuchos::ParameterList& input);

  /// Opens the file of a run and checks that it is whole and belongs to the input's model. Throws FileError.
  /// Collective.
  ReductionFile(const Teuchos::ParameterList& input, const Teuchos::RCP<const Communicator>& communicator);

  /// Throws FileError unless the file is of a model with so many particles and components.
  void require_size(const Map& rows, std::size_t components) const;
  /// Throws FileError unless a sampled model has so many components.
  void require_components(std::size_t components) const;
  /// Throws FileError unless time step and scheme of the input are those of the training.
  void require_time(const Teuchos::ParameterList& input) const;
  /// Throws FileError unless the run of an input ends where the training did, or earlier: nothing is known of later.
  void require_end(const Teuchos::ParameterList& input) const;

  const hdf5::Group& root() const { return file_; }
  /// Tells this reduction from one that was learnt anew.
  const std::string& fingerprint() const { return file_.fingerprint(); }
  int components() const { return components_; }
  long long particles() const { return particles_; }
  /// In the order of time; their coordinates lie one after the other.
  const std::vector<TimeWindow>& windows() const { return windows_; }
  /// Number of coordinates of all windows.
  int coordinates() const { return windows_.back().first + windows_.back().size; }

  BasisRows basis(const Map& particles) const;

  SampleMesh sample_mesh(std::size_t window) const;
  /// The group Model::save_sample wrote.
  hdf5::Group sample_model(std::size_t window) const;
  /// Whether the training clustered the sources of every window.
  bool clustered() const;
  /// The group ClusteredMesh::write wrote.
  hdf5::Group clusters(std::size_t window) const;
  /// The clusters of a window as particles, their ids above all particles'.
  ParticleTable cluster_table(std::size_t window) const;
  /// The sources of all sample meshes and the particles a run must be able to tell.
  ParticleTable held_particles() const;
  /// The sampled particles of all windows in place of their sources. Throws FileError where nothing is clustered.
  ParticleTable target_particles() const;
  Questions questions() const;
  std::vector<TrainedRange> trained_ranges() const;
  /// The errors of the training's trial runs (Reduction.hpp), of GNAT or on clustered sources; null while there are
  /// none.
  nlohmann::json trial(bool clustered) const;

 private:
  hdf5::Group window(std::size_t number) const;
  std::vector<TimeWindow> read_windows() const;
  /// Ids of particles, ascending, at least one.
  std::vector<GlobalIndex> ids(const hdf5::Group& group, const std::string& name) const;
  /// The same from `first` to `last`.
  std::vector<GlobalIndex> ids(const hdf5::Group& group, const std::string& name, GlobalIndex first,
                               GlobalIndex last) const;

  hdf5::File file_;
  int components_;
  long long particles_;
  std::vector<TimeWindow> windows_;
};

}  // namespace kiln
