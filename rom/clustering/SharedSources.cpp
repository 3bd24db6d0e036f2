#include "rom/clustering/SharedSources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

constexpr double round_off = 1e-12;
constexpr const char* instead = "weights that are the source's own; for others, source clustering of type 'per row'";

/// The source of `ids` that a row's ascending sources lack, the row itself apart; null: none.
const GlobalIndex* missing_source(const std::vector<GlobalIndex>& ids, const std::vector<GlobalIndex>& of_row,
                                  GlobalIndex row) {
  for (const GlobalIndex& id : ids) {
    if (id != row && !std::binary_search(of_row.begin(), of_row.end(), id)) return &id;
  }
  return nullptr;
}

}  // namespace

SharedSources::SharedSources(const PairWeights& pairs, const std::string& path) : ids(pairs.sources) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  weights.resize(ids.size());
  std::vector<GlobalIndex> weighed_by(ids.size(), -1);
  for (std::size_t row = 0; row < pairs.rows.size(); ++row) {
    const auto first = pairs.sources.begin() + static_cast<std::ptrdiff_t>(pairs.offsets[row]);
    std::vector<GlobalIndex> of_row(first, pairs.sources.begin() + static_cast<std::ptrdiff_t>(pairs.offsets[row + 1]));
    std::sort(of_row.begin(), of_row.end());
    own.push_back(std::binary_search(of_row.begin(), of_row.end(), pairs.rows[row]));
    if (const GlobalIndex* missing = missing_source(ids, of_row, pairs.rows[row])) {
      throw InputError(path,
                       fmt::format("particle {} is no source of row {}, as it is of others", *missing, pairs.rows[row]),
                       instead);
    }
    for (std::size_t pair = pairs.offsets[row]; pair < pairs.offsets[row + 1]; ++pair) {
      const std::size_t place = std::lower_bound(ids.begin(), ids.end(), pairs.sources[pair]) - ids.begin();
      if (weighed_by[place] < 0) {
        weighed_by[place] = pairs.rows[row];
        weights[place] = pairs.weights[pair];
      } else if (std::abs(pairs.weights[pair] - weights[place]) > round_off * std::abs(weights[place])) {
        throw InputError(path,
                         fmt::format("source {} weighs {:g} for row {} and {:g} for row {}", ids[place], weights[place],
                                     weighed_by[place], pairs.weights[pair], pairs.rows[row]),
                         instead);
      }
    }
  }
}

}  // namespace kiln
