#pragma once

#include <string>
#include <vector>

#include "framework/input/Location.hpp"
#include "framework/input/Mistakes.hpp"

namespace kiln {

struct YamlPair;

/// A parsed YAML value: aliases expanded, merge keys `<<` applied, each value with its place. The text of a scalar is
/// kept as written; its type is decided by the specification it is checked against.
struct YamlNode {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  std::string text;             ///< of a scalar
  std::vector<YamlNode> items;  ///< of a list
  std::vector<YamlPair> pairs;  ///< of a map, each key once
  Location location;            ///< of scalars and lists: the value's; of maps and nulls below a key: the key's

  static YamlNode scalar(std::string text, Location location);
  static YamlNode map(Location location);
  /// nullptr: no such key.
  const YamlNode* find(const std::string& key) const;
  YamlNode* find(const std::string& key);
  /// Adds a pair, or replaces the value of a present key. Returns the value.
  YamlNode& set(const std::string& key, const Location& location, YamlNode value);
  void erase(const std::string& key);
};

struct YamlPair {
  std::string key;
  Location location;
  YamlNode value;
};

/// The YAML text of one document. Places in it are `origin`'s file with their line and column; an origin of line 0 is
/// itself the place of everything. Returns false if the text cannot be understood; what is wrong goes to `mistakes`,
/// as do duplicated keys, after which parsing goes on. Refuses what is no text, tabs in the indentation, several
/// documents, cyclic aliases, aliases that expand to more than 100,000 values, more than 200,000 values in all or 5,000
/// keys in a block, more than 64 levels, and the character NUL, at which the system would end a file's name.
bool parse_yaml(std::string text, const Location& origin, YamlNode& root, Mistakes& mistakes);

}  // namespace kiln
