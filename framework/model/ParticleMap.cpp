#include "framework/model/ParticleMap.hpp"

#include <Teuchos_ArrayView.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>

namespace kiln {

Teuchos::RCP<const Map> map_of(const std::vector<GlobalIndex>& ids,
                               const Teuchos::RCP<const Communicator>& communicator) {
  const auto total = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return Teuchos::rcp(new Map(total, Teuchos::arrayViewFromVector(ids), GlobalIndex{0}, communicator));
}

}  // namespace kiln
