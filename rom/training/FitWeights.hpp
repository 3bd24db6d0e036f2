#pragma once

#include <vector>

#include "framework/model/PairwiseModel.hpp"
#include "rom/files/ParticleRows.hpp"

namespace kiln {

/// Fits the weights of each row's clusters to what the row's rate was in training. Means keep a rate that is linear in
/// the sources' states; of one that is not, they miss the mean of its curvature, with one sign at all moments, so that
/// the error adds up over time. Weights w_c (1 + d_c) make up for that:
///
///     min_d Σ_t ‖f_i − f_i,clustered − Σ_c d_c w_ic g(u_i, u_c)‖² + (ridge · size)² Σ_c d_c²,
///
/// over the moments t, size² the mean over c of Σ_t ‖w_ic g(u_i, u_c)‖². The ridge keeps weights near the sums they
/// come from, so that states of other parameters are met as well as before; where clusters are exact, d is zero.
///
/// `sample`: the model at clusters.rows with all their sources; `members`: all particles that occur; `clustered`: the
/// clusters themselves; `moments`: coordinates whose states these tell. Collective.
void fit_weights(const PairwiseModel& pairwise, const Model& sample, const ParticleTable& members,
                 const ParticleTable& clustered, const std::vector<VectorView>& moments, SourceClusters& clusters);

}  // namespace kiln
