#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>
#include <vector>

#include "framework/model/Model.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/sampling/GappyOperator.hpp"

namespace kiln {

/// All that training learns, before it is written. Row-space arrays stand on the full model's rows.
struct Reduction {
  const Teuchos::ParameterList& input;  ///< the whole checked input it was learnt with
  const Model& model;
  VectorView reference;  ///< u_ref at the rows
  const Pod& basis;
  const Pod& residual_basis;
  const GappyOperator& gappy_operator;
  const Model& sample;               ///< the model on the sampled particles alone
  std::vector<GlobalIndex> sampled;  ///< ids, ascending
  std::vector<GlobalIndex> queries;  ///< ids, ascending
};

/// Writes a reduction file: whole, or not at all. It holds everything an online run needs:
///
///     attributes      format, format_version, model_type, model_input (checked, as YAML), model_hash, provenance,
///                     components, particles
///     /parameters     live parameters of the model at training, one attribute each
///     /time           step in s and scheme (as YAML) of the training
///     /windows/0      one group a time window
///       basis/          reference (N), modes (N × M), singular_values; attributes energy, rank
///       sample_mesh/    rows, sources, and of the sources positions, reference, modes; gappy_operator (n_r × n_p),
///                       residual_singular_values; attributes sigma_min, condition, residual_rank, residual_energy;
///                       model/, written by the model itself
///       queries/        particles, and of them positions, reference, modes
///
/// Row i of basis/ belongs to particle i. Throws FileError. Collective.
void write_reduction(const std::filesystem::path& file, const Reduction& reduction);

}  // namespace kiln
