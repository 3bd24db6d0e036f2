#include "framework/model/DegreesOfFreedom.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>

namespace kiln {

Teuchos::RCP<const Map> degree_of_freedom_map(const Teuchos::RCP<const Map>& particles, int components) {
  if (components == 1) return particles;
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const std::size_t local = local_size(*particles);
  if (particles->isContiguous()) {
    return Teuchos::rcp(
        new Map(unknown, local * components, particles->getIndexBase() * components, particles->getComm()));
  }
  Teuchos::Array<GlobalIndex> ids(local * components);
  for (std::size_t i = 0; i < local; ++i) {
    const GlobalIndex particle = particles->getGlobalElement(static_cast<LocalIndex>(i));
    for (int c = 0; c < components; ++c) ids[i * components + c] = particle * components + c;
  }
  return Teuchos::rcp(new Map(unknown, ids(), particles->getIndexBase() * components, particles->getComm()));
}

}  // namespace kiln
