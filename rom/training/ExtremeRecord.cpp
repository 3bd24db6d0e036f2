#include "rom/training/ExtremeRecord.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <limits>

namespace kiln {

ExtremeRecord::ExtremeRecord(Method& method)
    : method_(method),
      components_(method.fields().size()),
      state_("kiln::rom::state", local_size(*method.particles()) * components_) {}

void ExtremeRecord::observe(const Moment& moment) {
  if (moment.step == 0) return;
  method_.state(moment.x, state_);
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t component = 0; component < components_; ++component) {
      double most = -std::numeric_limits<double>::infinity();
      GlobalIndex place = -1;
      for (std::size_t i = component; i < state_.extent(0); i += components_) {
        if (!(sign * state_(i) > most)) continue;
        most = sign * state_(i);
        place = static_cast<GlobalIndex>(i / components_);
      }
      values_.push_back(most);
      places_.push_back(place < 0 ? place : method_.particles()->getGlobalElement(static_cast<LocalIndex>(place)));
    }
  }
}

std::vector<GlobalIndex> ExtremeRecord::ids() const {
  const Communicator& communicator = *method_.particles()->getComm();
  const int count = static_cast<int>(values_.size());
  std::vector<double> most(values_.size());
  if (count > 0) Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, count, values_.data(), most.data());
  // Equal values go to the lowest id, whichever rank holds it.
  constexpr GlobalIndex nowhere = std::numeric_limits<GlobalIndex>::max();
  std::vector<GlobalIndex> mine(places_.size(), nowhere), ids(places_.size());
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (values_[k] == most[k] && places_[k] >= 0) mine[k] = places_[k];
  }
  if (count > 0) Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, count, mine.data(), ids.data());
  return ids;
}

}  // namespace kiln
