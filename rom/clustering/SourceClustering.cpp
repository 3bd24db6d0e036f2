#include "rom/clustering/SourceClustering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kiln {

std::size_t SourceMotion::place(GlobalIndex id) const {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found == ids.end() || *found != id) throw std::logic_error(fmt::format("no motion of particle {} is known", id));
  return static_cast<std::size_t>(found - ids.begin());
}

}  // namespace kiln
