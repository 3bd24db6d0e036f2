#include "rom/files/YamlDifference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "framework/input/Yaml.hpp"

namespace kiln {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

using Kind = YamlNode::Kind;

bool is_list_of_scalars(const YamlNode& node) {
  return node.kind == Kind::list && std::all_of(node.items.begin(), node.items.end(),
                                                [](const YamlNode& item) { return item.kind == Kind::scalar; });
}

/// Leaves with their paths: scalars, and lists of scalars as one text.
void flatten(const YamlNode& node, const std::string& path, Entries& entries) {
  if (node.kind == Kind::map) {
    for (const YamlPair& entry : node.pairs) flatten(entry.value, path + "." + entry.key, entries);
  } else if (is_list_of_scalars(node)) {
    std::vector<std::string> items;
    for (const YamlNode& item : node.items) items.push_back(item.text);
    entries.emplace_back(path, fmt::format("[{}]", fmt::join(items, ", ")));
  } else if (node.kind == Kind::list) {
    for (std::size_t k = 0; k < node.items.size(); ++k) {
      flatten(node.items[k], fmt::format("{}.{}", path, k), entries);
    }
  } else {
    entries.emplace_back(path, node.text);
  }
}

YamlNode parsed(const std::string& text) {
  YamlNode node;
  Mistakes mistakes;
  if (!parse_yaml(text, {"the text", 0, 0}, node, mistakes) || mistakes.count() != 0) throw mistakes.error();
  return node;
}

}  // namespace

std::vector<YamlDifference> differences(const std::string& first, const std::string& second, const std::string& prefix,
                                        const std::vector<std::string>& except) {
  Entries entries, others;
  flatten(parsed(first), prefix, entries);
  flatten(parsed(second), prefix, others);
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
