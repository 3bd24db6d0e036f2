#pragma once

#include <string>
#include <vector>

namespace kiln {

/// An entry that two YAML texts give differently.
struct YamlDifference {
  std::string path;    ///< dotted, list items by number
  std::string first;   ///< as written; empty: not there
  std::string second;  ///< likewise
};

/// Entries that differ between two texts of `to_yaml`, in the order of the first one, then those only the second has.
/// `prefix` stands before each path. Entries at the paths of `except`, or above one (a list whose numbers are named one
/// by one), are left out.
std::vector<YamlDifference> differences(const std::string& first, const std::string& second, const std::string& prefix,
                                        const std::vector<std::string>& except);

}  // namespace kiln
