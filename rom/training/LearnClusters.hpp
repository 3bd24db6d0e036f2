#pragma once

#include <Teuchos_ParameterList.hpp>
#include <vector>

#include "rom/files/Reduction.hpp"
#include "rom/training/LearntStates.hpp"

namespace kiln {

/// Steps of a time window, its last one among them, at which a training keeps the state for source clustering: at most
/// as many as the clustering wants. `block`: the input's `clustering`; `first`: the step the window begins with.
std::vector<int> clustering_steps(const Teuchos::ParameterList& block, int first, int last);

/// Throws InputError for a model that is no PairwiseModel, and where the pairs of two of its rows tell that the
/// clustering does not serve them. `block`: the input's `clustering`. Collective.
void check_clustering(const Teuchos::ParameterList& block, const Model& model);

/// Clusters the sources of the newest window's sampled rows and builds the model on them. `reference`: u_ref at the
/// model's rows; `windows`: those learnt so far; `states`: at the newest one's beginning and at its clustering_steps();
/// `block`: the input's `clustering`. Throws InputError for a model that is no
/// PairwiseModel, and for pairs the clustering does not serve. Collective.
ClusteredMesh learn_clusters(const Teuchos::ParameterList& block, const Model& model, const VectorView& reference,
                             const std::vector<WindowReduction>& windows, const LearntStates& states);

}  // namespace kiln
