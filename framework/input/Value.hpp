#pragma once

#include <string>

#include "framework/input/InputFiles.hpp"
#include "framework/input/Mistakes.hpp"
#include "framework/input/Yaml.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Values of an entry that holds no block: read from YAML or taken from the default, checked, put into a list.
class ValueReader {
 public:
  /// `folder` is where relative files of defaults and overrides lie.
  ValueReader(InputFiles& files, Mistakes& mistakes, std::string folder)
      : files_(files), mistakes_(mistakes), folder_(std::move(folder)) {}

  /// Adds what is wrong with the value at `path`, or else sets it in `list`.
  void read(const YamlNode& node, const Entry& entry, const std::string& path, Teuchos::ParameterList& list);
  /// Throws std::logic_error if the default is of another kind than the entry.
  void set_default(const Entry& entry, const std::string& path, const Location& location, Teuchos::ParameterList& list);

 private:
  void read_list(const YamlNode& node, const Entry& entry, const std::string& path, Teuchos::ParameterList& list);
  double real(const YamlNode& node, const Entry& entry) const;
  int integer(const YamlNode& node, const Entry& entry) const;
  bool flag(const YamlNode& node) const;
  std::string choice(const YamlNode& node, const Entry& entry) const;
  std::string file(const std::string& name, const Location& location);

  InputFiles& files_;
  Mistakes& mistakes_;
  std::string folder_;
};

/// What stands in the file instead of what is wanted: "a list is given", "no value is given".
std::string what_is_given(const YamlNode& node);

}  // namespace kiln
