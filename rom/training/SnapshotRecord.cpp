#include "rom/training/SnapshotRecord.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>

namespace kiln {

SnapshotRecord::SnapshotRecord(Method& method, Snapshots& snapshots, int every)
    : method_(method),
      snapshots_(snapshots),
      every_(every),
      reference_("kiln::rom::reference", snapshots.rows()),
      state_("kiln::rom::state", snapshots.rows()) {
  VectorView x("kiln::rom::unknown", local_size(*method.coordinates()));
  method.initial(x);
  method.state(x, reference_);
}

void SnapshotRecord::observe(const Moment& moment) {
  if (moment.step == 0 || (moment.step % every_ != 0 && moment.step != moment.last_step)) return;
  method_.state(moment.x, state_);
  for (std::size_t i = 0; i < state_.extent(0); ++i) state_(i) -= reference_(i);
  snapshots_.append(state_);
}

StateRecord::StateRecord(Method& method, const std::vector<int>& steps, Snapshots& states)
    : steps_(steps), every_(method, states, 1) {}

void StateRecord::observe(const Moment& moment) {
  if (std::binary_search(steps_.begin(), steps_.end(), moment.step)) every_.observe(moment);
}

}  // namespace kiln
