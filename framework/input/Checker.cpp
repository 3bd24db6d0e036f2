#include "framework/input/Checker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"
#include "framework/registry/EntryText.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;

std::string join(const std::string& path, const std::string& key) {
  return path.empty() || key.empty() ? path + key : path + "." + key;
}

Teuchos::ParameterList& add_sublist(Teuchos::ParameterList& list, const std::string& key, const std::string& path) {
  return list.sublist(key).setName(path);
}

/// Keys that Specification::blocks adds to a block's own.
std::vector<std::string> block_keys(const Specification& specification) {
  std::vector<std::string> keys;
  for (const auto& entry : specification.entries()) {
    if (entry->kind != Kind::blocks) continue;
    for (const std::string& name : catalogue::names(entry->category)) keys.push_back(block_key(name));
  }
  return keys;
}

bool has_own_key(const Specification& specification, const std::string& key) {
  return std::any_of(specification.entries().begin(), specification.entries().end(),
                     [&](const auto& entry) { return entry->kind != Kind::blocks && entry->key == key; });
}

}  // namespace

void Checker::check(const YamlNode& root, const Specification& specification, Teuchos::ParameterList& list) {
  locations_[""] = root.location;
  list.setName("");
  check_block(root, specification, "", {}, list);
}

void Checker::check_block(const YamlNode& block, const Specification& specification, const std::string& path,
                          const std::vector<std::string>& other_keys, Teuchos::ParameterList& list) {
  const std::size_t before = mistakes_.count();
  check_keys(block, specification, path, other_keys);
  for (const auto& entry : specification.entries()) {
    if (entry->kind == Kind::blocks) {
      check_blocks(block, specification, *entry, path, list);
      continue;
    }
    const YamlNode* value = block.find(entry->key);
    const std::string entry_path = join(path, entry->key);
    if (value == nullptr) {
      check_missing(block, *entry, entry_path, list);
    } else {
      locations_[entry_path] = value->location;
      check_entry(*value, *entry, entry_path, list);
    }
  }
  if (mistakes_.count() == before) run_conditions(block, specification, path, list);
}

void Checker::check_keys(const YamlNode& block, const Specification& specification, const std::string& path,
                         const std::vector<std::string>& other_keys) {
  std::vector<std::string> known = other_keys;
  for (const auto& entry : specification.entries()) {
    if (entry->kind != Kind::blocks) known.push_back(entry->key);
  }
  for (const std::string& key : block_keys(specification)) {
    if (std::find(known.begin(), known.end(), key) == known.end()) known.push_back(key);
  }
  for (const YamlPair& pair : block.pairs) {
    if (std::find(known.begin(), known.end(), pair.key) != known.end()) continue;
    std::string expected = known.empty() ? "no keys" : fmt::format("one of: {}", fmt::join(known, ", "));
    std::string meant = mistakes_.enough() ? "" : nearest(pair.key, known);
    mistakes_.add(pair.location, {join(path, shown(pair.key)), "unknown key", std::move(expected), std::move(meant)});
  }
}

void Checker::check_blocks(const YamlNode& block, const Specification& specification, const Entry& entry,
                           const std::string& path, Teuchos::ParameterList& list) {
  for (const std::string& name : catalogue::names(entry.category)) {
    const std::string key = block_key(name);
    const YamlNode* value = block.find(key);
    if (value == nullptr || has_own_key(specification, key)) continue;
    const std::string block_path = join(path, key);
    locations_[block_path] = value->location;
    if (value->kind != YamlNode::Kind::map && value->kind != YamlNode::Kind::null) {
      mistakes_.add(
          value->location,
          {block_path, what_is_given(*value), fmt::format("a block of the {} '{}'", entry.category, name), {}});
      continue;
    }
    // A checked block that is read again names its type.
    const YamlNode* type = value->find("type");
    if (type != nullptr && type->text != name) {
      mistakes_.add(type->location,
                    {join(block_path, "type"), what_is_given(*type), fmt::format("'{}', or no type", name), {}});
      continue;
    }
    Teuchos::ParameterList& sublist = add_sublist(list, key, block_path);
    sublist.set("type", name);
    check_block(*value, catalogue::find(entry.category, name, block_path).specification(), block_path, {"type"},
                sublist);
  }
}

void Checker::run_conditions(const YamlNode& block, const Specification& specification, const std::string& path,
                             const Teuchos::ParameterList& list) {
  std::vector<Problem> problems;
  for (const Specification::Check& condition : specification.checks()) {
    try {
      condition(list, problems);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  for (Problem& problem : problems) {
    problem.path = join(path, problem.path);
    std::string place = problem.path;
    // The nearest block of the file around an entry that has its default.
    while (locations_.count(place) == 0 && place.size() > path.size()) {
      const std::size_t dot = place.rfind('.');
      place = dot == std::string::npos ? "" : place.substr(0, dot);
    }
    const auto known = locations_.find(place);
    mistakes_.add(known == locations_.end() ? block.location : known->second, std::move(problem));
  }
}

void Checker::check_missing(const YamlNode& block, const Entry& entry, const std::string& path,
                            Teuchos::ParameterList& list) {
  if (entry.fallback.index() == 0) {
    if (!entry.required) return;
    if (entry.kind == Kind::section && entry.nested->has_defaults_only()) {
      check_block(YamlNode::map(block.location), *entry.nested, path, {}, add_sublist(list, entry.key, path));
      return;
    }
    mistakes_.add(block.location, {path, "missing", expectation(entry), {}});
    return;
  }
  if (entry.kind == Kind::component) {
    check_component(YamlNode::map(block.location), entry, std::get<std::string>(entry.fallback), path,
                    add_sublist(list, entry.key, path));
  } else if (entry.kind == Kind::components) {
    YamlNode types;
    types.kind = YamlNode::Kind::list;
    types.location = block.location;
    for (const std::string& type : std::get<std::vector<std::string>>(entry.fallback)) {
      types.items.push_back(YamlNode::scalar(type, block.location));
    }
    check_list(types, entry, path, list);
  } else {
    values_.set_default(entry, path, block.location, list);
  }
}

void Checker::check_entry(const YamlNode& value, const Entry& entry, const std::string& path,
                          Teuchos::ParameterList& list) {
  switch (entry.kind) {
    case Kind::section:
      if (value.kind == YamlNode::Kind::map || value.kind == YamlNode::Kind::null) {
        check_block(value, *entry.nested, path, {}, add_sublist(list, entry.key, path));
      } else {
        mistakes_.add(value.location, {path, what_is_given(value), expectation(entry), {}});
      }
      return;
    case Kind::component: {
      const auto* type = std::get_if<std::string>(&entry.fallback);
      check_component(value, entry, type == nullptr ? "" : *type, path, add_sublist(list, entry.key, path));
      return;
    }
    case Kind::sections:
    case Kind::components:
      check_list(value, entry, path, list);
      return;
    case Kind::dictionary:
      check_dictionary(value, entry, path, list);
      return;
    default:
      if (value.kind == YamlNode::Kind::list) {
        for (std::size_t i = 0; i < value.items.size(); ++i) {
          locations_[fmt::format("{}.{}", path, i)] = value.items[i].location;
        }
      }
      values_.read(value, entry, path, list);
  }
}

void Checker::check_dictionary(const YamlNode& value, const Entry& entry, const std::string& path,
                               Teuchos::ParameterList& list) {
  if (value.kind != YamlNode::Kind::map && value.kind != YamlNode::Kind::null) {
    mistakes_.add(value.location, {path, what_is_given(value), expectation(entry), {}});
    return;
  }
  Teuchos::ParameterList& sublist = add_sublist(list, entry.key, path);
  for (const YamlPair& pair : value.pairs) {
    const std::string pair_path = join(path, pair.key);
    locations_[pair_path] = pair.value.location;
    Entry item;
    item.key = pair.key;
    item.kind = pair.value.kind == YamlNode::Kind::list ? Kind::texts : Kind::text;
    if (pair.value.kind == YamlNode::Kind::map || pair.value.kind == YamlNode::Kind::null) {
      // YAML reads {word} without quotes as a block with the key `word`.
      const bool braces = pair.value.pairs.size() == 1 && pair.value.pairs[0].value.kind == YamlNode::Kind::null;
      mistakes_.add(pair.value.location, {pair_path, what_is_given(pair.value), "a text or a list of texts",
                                          braces ? fmt::format("\"{{{}}}\"", pair.value.pairs[0].key) : ""});
    } else {
      check_entry(pair.value, item, pair_path, sublist);
    }
  }
}

void Checker::check_list(const YamlNode& value, const Entry& entry, const std::string& path,
                         Teuchos::ParameterList& list) {
  // An empty list of blocks is written as an empty block in checked inputs.
  const bool empty_block = value.kind == YamlNode::Kind::map && value.pairs.empty();
  if (value.kind != YamlNode::Kind::list && !empty_block) {
    mistakes_.add(value.location, {path, what_is_given(value), expectation(entry), {}});
    return;
  }
  if (entry.required && value.items.empty()) {
    mistakes_.add(value.location, {path, "an empty list is given", expectation(entry), {}});
    return;
  }
  if (entry.length != 0 && value.items.size() != static_cast<std::size_t>(entry.length)) {
    mistakes_.add(
        value.location,
        {path, fmt::format("a list of {} is given", value.items.size()), fmt::format("{} items", entry.length), {}});
  }
  Teuchos::ParameterList& sublist = add_sublist(list, entry.key, path);
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const YamlNode& item = value.items[i];
    const std::string item_path = fmt::format("{}.{}", path, i);
    Teuchos::ParameterList& item_list = add_sublist(sublist, std::to_string(i), item_path);
    locations_[item_path] = item.location;
    if (entry.kind == Kind::components) {
      check_component(item, entry, "", item_path, item_list);
    } else if (item.kind == YamlNode::Kind::map) {
      check_block(item, *entry.nested, item_path, {}, item_list);
    } else {
      mistakes_.add(item.location, {item_path, what_is_given(item), expectation(entry), {}});
    }
  }
}

void Checker::check_component(const YamlNode& value, const Entry& entry, const std::string& fallback,
                              const std::string& path, Teuchos::ParameterList& list) {
  const auto refuse = [&](const std::string& place, const Location& location, std::string found) {
    mistakes_.add(location, {place, std::move(found), expectation(entry), {}});
  };
  YamlNode type = YamlNode::scalar(fallback, value.location);
  std::string type_path = path;
  if (value.kind == YamlNode::Kind::scalar) {
    type = value;
  } else if (value.kind == YamlNode::Kind::list) {
    return refuse(path, value.location, what_is_given(value));
  } else if (const YamlNode* given = value.find("type")) {
    type = *given;
    type_path = join(path, "type");
    locations_[type_path] = type.location;
    if (type.kind != YamlNode::Kind::scalar) return refuse(type_path, type.location, what_is_given(type));
  } else if (fallback.empty()) {
    if (value.pairs.empty()) return refuse(path, value.location, what_is_given(value));
    // Where the first of its keys stands: a block of several files begins in the one that is included.
    return refuse(path, value.pairs.front().location, "the key 'type' is missing");
  }
  const Registration* registration = nullptr;
  try {
    registration = &catalogue::find(entry.category, type.text, type_path);
  } catch (const InputError& error) {
    mistakes_.add(type.location, error.problems().front());
    return;
  }
  list.set("type", type.text);
  const YamlNode short_form = YamlNode::map(value.location);
  const bool is_short = value.kind == YamlNode::Kind::scalar;
  check_block(is_short ? short_form : value, registration->specification(), path, {"type"}, list);
}

}  // namespace kiln
