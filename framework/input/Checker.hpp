#pragma once

#include <map>
#include <string>

#include "framework/input/Mistakes.hpp"
#include "framework/input/Value.hpp"
#include "framework/input/Yaml.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// One pass over a YAML tree and its specification, side by side: collects the mistakes, fills the checked list in the
/// order of the specification, and notes where each entry stands.
class Checker {
 public:
  /// `folder` is where relative files of defaults and overrides lie.
  Checker(InputFiles& files, Mistakes& mistakes, std::string folder)
      : mistakes_(mistakes), values_(files, mistakes, std::move(folder)) {}

  /// `root` is a map; its location is the file's.
  void check(const YamlNode& root, const Specification& specification, Teuchos::ParameterList& list);

  const std::map<std::string, Location>& locations() const { return locations_; }

 private:
  void check_block(const YamlNode& block, const Specification& specification, const std::string& path,
                   const std::vector<std::string>& other_keys, Teuchos::ParameterList& list);
  void check_keys(const YamlNode& block, const Specification& specification, const std::string& path,
                  const std::vector<std::string>& other_keys);
  void check_blocks(const YamlNode& block, const Specification& specification, const Entry& entry,
                    const std::string& path, Teuchos::ParameterList& list);
  void run_conditions(const YamlNode& block, const Specification& specification, const std::string& path,
                      const Teuchos::ParameterList& list);
  void check_entry(const YamlNode& value, const Entry& entry, const std::string& path, Teuchos::ParameterList& list);
  void check_missing(const YamlNode& block, const Entry& entry, const std::string& path, Teuchos::ParameterList& list);
  void check_dictionary(const YamlNode& value, const Entry& entry, const std::string& path,
                        Teuchos::ParameterList& list);
  void check_list(const YamlNode& value, const Entry& entry, const std::string& path, Teuchos::ParameterList& list);
  /// `fallback`: the type of a block that names none; empty: it must.
  void check_component(const YamlNode& value, const Entry& entry, const std::string& fallback, const std::string& path,
                       Teuchos::ParameterList& list);

  Mistakes& mistakes_;
  ValueReader values_;
  std::map<std::string, Location> locations_;
};

}  // namespace kiln
