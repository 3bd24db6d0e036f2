#include "framework/model/SampleRows.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"

namespace kiln {

std::vector<GlobalIndex> checked_rows(std::vector<GlobalIndex> ids, const Map& model_rows) {
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end()) {
    throw InputError("", fmt::format("particle {} is sampled twice", *twice), "each particle once");
  }
  std::vector<GlobalIndex> known;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(known),
               [&](GlobalIndex id) { return model_rows.isNodeGlobalElement(id); });
  known = concatenated(*model_rows.getComm(), known);
  std::sort(known.begin(), known.end());
  const auto unknown = std::find_if_not(
      ids.begin(), ids.end(), [&](GlobalIndex id) { return std::binary_search(known.begin(), known.end(), id); });
  if (unknown != ids.end()) {
    throw InputError("", fmt::format("particle {} is no row of the model", *unknown),
                     fmt::format("ids of the model's {} rows", model_rows.getGlobalNumElements()));
  }
  return ids;
}

}  // namespace kiln
