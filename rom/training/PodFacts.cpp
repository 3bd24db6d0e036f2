#include "rom/training/PodFacts.hpp"

#include <nlohmann/json.hpp>

namespace kiln {

nlohmann::json facts_of(const Pod& pod) {
  return {{"rank", pod.truncation.rank},
          {"energy", pod.truncation.energy},
          {"independent", pod.truncation.independent},
          {"snapshots", pod.snapshots},
          {"largest_singular_value", pod.singular_values.front()},
          {"last_singular_value_kept", pod.singular_values[pod.truncation.rank - 1]},
          {"orthogonality", pod.orthogonality},
          {"reorthogonalised", pod.reorthogonalised}};
}

}  // namespace kiln
