#include "rom/files/YamlDifference.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>

namespace kiln {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

bool is_list_of_scalars(const YAML::Node& node) {
  return node.IsSequence() &&
         std::all_of(node.begin(), node.end(), [](const YAML::Node& item) { return item.IsScalar(); });
}

/// Leaves with their paths: scalars, and lists of scalars as one text.
void flatten(const YAML::Node& node, const std::string& path, Entries& entries) {
  if (node.IsMap()) {
    for (const auto& entry : node) flatten(entry.second, path + "." + entry.first.as<std::string>(), entries);
  } else if (is_list_of_scalars(node)) {
    std::vector<std::string> items;
    for (const YAML::Node& item : node) items.push_back(item.Scalar());
    entries.emplace_back(path, fmt::format("[{}]", fmt::join(items, ", ")));
  } else if (node.IsSequence()) {
    for (std::size_t k = 0; k < node.size(); ++k) flatten(node[k], fmt::format("{}.{}", path, k), entries);
  } else {
    entries.emplace_back(path, node.IsScalar() ? node.Scalar() : "");
  }
}

}  // namespace

std::vector<YamlDifference> differences(const std::string& first, const std::string& second, const std::string& prefix,
                                        const std::vector<std::string>& except) {
  Entries entries, others;
  flatten(YAML::Load(first), prefix, entries);
  flatten(YAML::Load(second), prefix, others);
  const auto excepted = [&except](const std::string& path) {
    return std::any_of(except.begin(), except.end(), [&path](const std::string& name) {
      return name == path || name.compare(0, path.size() + 1, path + ".") == 0;
    });
  };
  std::map<std::string, std::string> left(others.begin(), others.end());
  std::vector<YamlDifference> result;
  for (const auto& [path, value] : entries) {
    const auto other = left.find(path);
    const std::string given = other == left.end() ? "" : other->second;
    if ((other == left.end() || given != value) && !excepted(path)) result.push_back({path, value, given});
    if (other != left.end()) left.erase(other);
  }
  for (const auto& [path, value] : others) {
    if (left.count(path) != 0 && !excepted(path)) result.push_back({path, "", value});
  }
  return result;
}

}  // namespace kiln
