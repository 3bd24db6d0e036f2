#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
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

/// Local arrays of all ranks, one after the other, on each rank. Collective.
template <class T>
std::vector<T> gathered(const std::vector<T>& local, const Communicator& communicator) {
  const int ranks = communicator.getSize();
  std::vector<int> counts(ranks);
  const int count = static_cast<int>(local.size());
  Teuchos::gatherAll(communicator, 1, &count, ranks, counts.data());
  const int widest = *std::max_element(counts.begin(), counts.end());
  std::vector<T> padded(local);
  padded.resize(widest);
  std::vector<T> received(static_cast<std::size_t>(widest) * ranks);
  if (widest > 0) {
    Teuchos::gatherAll(communicator, widest, padded.data(), widest * ranks, received.data());
  }
  std::vector<T> all;
  for (int rank = 0; rank < ranks; ++rank) {
    const auto first = received.begin() + static_cast<std::ptrdiff_t>(widest) * rank;
    all.insert(all.end(), first, first + counts[rank]);
  }
  return all;
}

/// The order in which ids ascend.
std::vector<std::size_t> ascending(const std::vector<GlobalIndex>& ids);

}  // namespace kiln
