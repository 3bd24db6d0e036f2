#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <vector>

#include "physics/sph/Kernel.hpp"
#include "physics/sph/LatticeStencil.hpp"
#include "physics/sph/MaterialTable.hpp"
#include "physics/sph/Neighbours.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {

namespace hdf5 {
class Group;
}

struct SourceClusters;

/// What the heat model keeps of its particles on this rank: rows, their sources, and the pairs between them. Neighbours
/// of a row are ordered by global id, so that sums do not depend on the number of ranks.
struct HeatDomain {
  Teuchos::RCP<const Map> rows;     ///< ascending by global id
  Teuchos::RCP<const Map> sources;  ///< the rows, then the others, each ascending
  PositionView positions;           ///< of the sources
  VectorView masses;                ///< m_i in kg of the sources
  VectorView areas;                 ///< A_i in m² of the rows
  NeighbourList pairs;              ///< of the rows, as local indices into the sources
  VectorView weights;               ///< of the pairs, (dW/dr)/r in 1/m⁵
  /// Whether of any two rows each lists the other, with one weight. Not so for rows with sources of their own choice.
  bool mutual = false;
  /// When the whole part stands on a lattice; a sample mesh has none.
  std::optional<LatticeStencil> stencil;
};

/// How the pairs of a whole part are made.
struct PairSettings {
  const Kernel& kernel;
  double support;  ///< 2h in m
  bool mirrored;
  double density;    ///< ρ(u0) in kg/m³, which fixes the masses
  std::string path;  ///< of the model in the input, for errors
};

/// Distributes a cloud over the ranks and finds the pairs. Throws InputError for positions that are not finite,
/// particles that coincide or have no neighbour, and mirroring without faces. Collective.
HeatDomain whole_domain(const ParticleCloud& cloud, const PairSettings& settings,
                        const Teuchos::RCP<const Communicator>& communicator);

/// The part of a domain that the given rows need; each row stays on its rank. Throws InputError for a row that the
/// domain does not have or that is listed twice. Collective.
HeatDomain sampled_domain(const HeatDomain& domain, const std::vector<GlobalIndex>& rows);

/// As sampled_domain for the rows of the clusters, whose sources are the rows and, with the ids that PairwiseModel
/// gives them, the clusters: each has the mean mass and position of its members, and its pair the weight that makes
/// weight · mass the cluster's. Throws InputError for a member that the domain does not have. Collective.
HeatDomain clustered_domain(const HeatDomain& domain, const SourceClusters& clusters);

/// Writes a domain in an order that does not depend on the number of ranks. Collective.
void save_domain(const HeatDomain& domain, hdf5::Group& group);

/// Reads a saved domain; ranks get contiguous blocks of rows with like numbers of pairs. Throws FileError for data that
/// do not fit together. Collective.
HeatDomain restored_domain(const hdf5::Group& group, const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
