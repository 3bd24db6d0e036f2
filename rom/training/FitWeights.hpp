#pragma once

#include <vector>

#include "framework/model/PairwiseModel.hpp"
#include "rom/clustering/SourceClustering.hpp"
#include "rom/files/ParticleRows.hpp"
#include "rom/training/LearntStates.hpp"

namespace kiln {

/// Fits the weights of each row's clusters to what the row's rate was in training, over the states t.
///
/// Where a row keeps all its clusters (fit.most is 0), weights w_ic (1 + d_c) stay near the sums they come from. Means
/// keep a rate that is linear in the sources' states; of one that is not, they miss the mean of its curvature, with one
/// sign in all states, so that the error adds up over time:
///
///     min_d Σ_t ‖f_i − f_i,clustered − Σ_c d_c w_ic g(u_i, u_c)‖² + (ridge · size)² Σ_c d_c²,
///
/// size² the mean over c of Σ_t ‖w_ic g(u_i, u_c)‖². Where clusters are exact, d is zero.
///
/// Else the given weights are scales, and a row's sum is made anew of at most fit.most of its clusters,
///
///     min_z Σ_t ‖f_i − h_i − Σ_c z_c w_ic g(u_i, u_c)‖² + (ridge · size)² Σ_c z_c²,
///
/// one more at a time, that along which most of what is still missing lies (orthogonal matching pursuit; Pati,
/// Rezaiifar, Krishnaprasad 1993); the others leave the row. h_i is the row's own term.
///
/// Each rate is taken with the live parameters of its state's point. `sample`: the model at clusters.rows with all
/// their sources, whose parameters end as they began; `members`: all particles that occur; `clustered`: the clusters
/// themselves. Finds the same on any number of ranks. Collective.
void fit_weights(const PairwiseModel& pairwise, Model& sample, const ParticleTable& members,
                 const ParticleTable& clustered, const LearntStates& states, const WeightFit& fit,
                 SourceClusters& clusters);

}  // namespace kiln
