#pragma once

#include <vector>

#include "physics/sph/HeatDomain.hpp"

/// Domains as plain arrays on the host, while they are taken apart, put together and moved between ranks.
namespace kiln {

/// This rank's data of a domain.
struct HostDomain {
  explicit HostDomain(const HeatDomain& domain);

  std::vector<GlobalIndex> rows, sources;
  PositionView::HostMirror positions;
  VectorView::HostMirror masses, areas;
  OffsetView::HostMirror offsets;
  IndexView::HostMirror neighbours;
  VectorView::HostMirror weights;
};

/// The pieces of a domain, neighbours as indices into the sources.
struct DomainParts {
  std::vector<GlobalIndex> rows, sources;
  std::vector<Point> positions;
  std::vector<double> masses, areas, weights;
  std::vector<std::size_t> offsets{0};
  std::vector<LocalIndex> neighbours;
};

/// The domain that these pieces make. Collective.
HeatDomain assembled(const DomainParts& parts, const Teuchos::RCP<const Communicator>& communicator);

/// The order in which ids ascend.
std::vector<std::size_t> ascending(const std::vector<GlobalIndex>& ids);

}  // namespace kiln
