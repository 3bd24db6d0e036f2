#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/model/Model.hpp"
#include "framework/model/ParameterPoints.hpp"
#include "rom/files/ClusteredMesh.hpp"
#include "rom/files/Questions.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/sampling/GappyOperator.hpp"

namespace kiln {

/// What training learns of one time window.
struct WindowReduction {
  double end;  ///< s; TimeWindow
  Pod basis;
  Pod residual_basis;  ///< its modes may have been dropped: only the gappy operator is written
  GappyOperator gappy_operator;
  std::vector<GlobalIndex> sampled;  ///< ids, ascending
  std::unique_ptr<Model> sample;     ///< the model on the sampled particles alone
  std::optional<ClusteredMesh> clustered = {};
};

/// All that training learns, before it is written. Row-space arrays stand on the full model's rows.
struct Reduction {
  const Teuchos::ParameterList& input;  ///< the whole checked input it was learnt with
  const Model& model;
  VectorView reference;  ///< u_ref at the rows
  std::vector<WindowReduction> windows;
  Questions questions;  ///< without their spacing, which follows from the particles that are held
  /// Ids, ascending: where a component was highest or lowest at any step of the training.
  std::vector<GlobalIndex> extremes;
  ParameterPoints points;                          ///< all live parameters, where it was learnt and is to be tried
  std::map<std::string, std::string> data_hashes;  ///< reduction_identity::data_hashes() when the model was made
};

/// Writes a reduction file. It holds everything an online run needs:
///
///     attributes      format, format_version, model_type, model_input (checked, as YAML), model_hash, provenance,
///                     components, particles; trial (JSON), the errors of the training's trial run;
///                     trial_clustered (JSON), those of the clustered mesh's, where there is one
///     /data_files     hashes of the data files that model_input names, one attribute (JSON) each
///     /parameters     live parameters of the model at training, one attribute each
///     /points         their values where it was learnt and tried, one dataset each
///     /time           step in s and scheme (as YAML) of the training
///     /reference      u_ref (N)
///     /windows/0 …    one group a time window; attribute end (s)
///       basis/          modes (N × M), singular_values; attributes energy, rank
///       sample_mesh/    rows, sources (ids); gappy_operator (n_r × n_p), residual_singular_values; attributes
///                       sigma_min, condition, residual_rank, residual_energy; model/, written by the model itself
///     /particles      the sources of all windows and the queried particles: ids, positions, reference, modes (of all
///                     windows, one after the other), and the questions (Questions.hpp); the particles of the
///                     extremes, too
///     /targets        with source clustering: the same of the sampled particles in place of their sources
///
/// Row i of reference and basis/ belongs to particle i. Online, a hyper-reduced run reads nothing of size N. Throws
/// FileError. Collective.
void write_reduction(const std::string& file, const Reduction& reduction);

}  // namespace kiln
