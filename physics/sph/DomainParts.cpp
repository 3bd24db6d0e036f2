#include "physics/sph/DomainParts.hpp"

#include <numeric>

#include "framework/base/ViewOf.hpp"
#include "framework/model/ParticleMap.hpp"

namespace kiln {
namespace {

std::vector<GlobalIndex> ids_of(const Map& map) {
  std::vector<GlobalIndex> result(static_cast<std::size_t>(local_size(map)));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = map.getGlobalElement(static_cast<LocalIndex>(i));
  return result;
}

}  // namespace

HostDomain::HostDomain(const HeatDomain& domain)
    : rows(ids_of(*domain.rows)),
      sources(ids_of(*domain.sources)),
      positions(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.positions)),
      masses(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.masses)),
      areas(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.areas)),
      offsets(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.offsets)),
      neighbours(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.pairs.neighbours)),
      weights(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain.weights)) {}

HeatDomain assembled(const DomainParts& parts, const Teuchos::RCP<const Communicator>& communicator) {
  HeatDomain domain;
  domain.rows = map_of(parts.rows, communicator);
  domain.sources = map_of(parts.sources, communicator);
  domain.positions = position_view(parts.positions);
  domain.masses = view_of<VectorView>(parts.masses, "sample");
  domain.areas = view_of<VectorView>(parts.areas, "sample");
  domain.weights = view_of<VectorView>(parts.weights, "sample");
  domain.pairs = {view_of<OffsetView>(parts.offsets, "sample"), view_of<IndexView>(parts.neighbours, "sample")};
  return domain;
}

std::vector<std::size_t> ascending(const std::vector<GlobalIndex>& ids) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&ids](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  return order;
}

}  // namespace kiln
