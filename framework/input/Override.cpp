#include "framework/input/Override.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "framework/base/Text.hpp"

namespace kiln {
namespace {

/// As deep as a file may be.
constexpr std::size_t deepest_path = 64;

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> keys(1);
  for (const char c : path) {
    if (c == '.') {
      keys.emplace_back();
    } else {
      keys.back() += c;
    }
  }
  return keys;
}

bool is_index(const std::string& key) {
  // Nine digits always fit an int.
  return !key.empty() && key.size() <= 9 &&
         std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::string override_place(const std::string& override_text) {
  constexpr std::size_t longest = 300;
  return "--set " + shown(override_text, longest);
}

void apply_override(const std::string& override_text, YamlNode& root, Mistakes& mistakes) {
  const Location place{override_place(override_text), 0, 0};
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos) {
    mistakes.add(place, {{}, "no '='", "path.to.key=value", {}});
    return;
  }
  const std::vector<std::string> keys = split(override_text.substr(0, equals));
  if (std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return key.empty(); })) {
    mistakes.add(place, {{}, "an empty key", "path.to.key=value", {}});
    return;
  }
  if (keys.size() > deepest_path) {
    mistakes.add(place,
                 {{}, fmt::format("a path of {} keys", keys.size()), fmt::format("at most {}", deepest_path), {}});
    return;
  }
  YamlNode value;
  if (!parse_yaml(override_text.substr(equals + 1), place, value, mistakes)) return;
  value.location = place;

  YamlNode* node = &root;
  std::string path;
  for (const std::string& key : keys) {
    path += (path.empty() ? "" : ".") + key;
    if (node->kind == YamlNode::Kind::list) {
      const std::size_t index = is_index(key) ? static_cast<std::size_t>(std::stoi(key)) : node->items.size() + 1;
      if (index > node->items.size()) {
        mistakes.add(place, {path,
                             fmt::format("the list has no item {}", in_quotes(key)),
                             fmt::format("a number from 0 to {}", node->items.size()),
                             {}});
        return;
      }
      if (index == node->items.size()) node->items.push_back(YamlNode::map(place));
      node = &node->items[index];
      continue;
    }
    if (node->kind == YamlNode::Kind::scalar) {
      // The short form of a component: its only content is its type.
      const YamlNode type = *node;
      *node = YamlNode::map(place);
      node->set("type", type.location, type);
    } else if (node->kind == YamlNode::Kind::null) {
      *node = YamlNode::map(place);
    }
    YamlNode* next = node->find(key);
    node = next != nullptr ? next : &node->set(key, place, YamlNode::map(place));
  }
  *node = std::move(value);
}

}  // namespace kiln
