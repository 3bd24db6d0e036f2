#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <string>
#include <vector>

#include "framework/base/Error.hpp"
#include "framework/base/LinearAlgebra.hpp"
#include "framework/input/Location.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// A YAML file checked against a specification: every key known, every value of its type and in its range, defaults
/// filled in. Sublists carry their dotted path as their name ("model.heat_source"), so that a component can say where a
/// mistake lies.
class Input {
 public:
  /// Reads the file once, on rank 0. `overrides` are "path.to.key=value" texts that go through the same checks.
  /// Throws InputError with all mistakes of the file at once; their text already has file:line:column in front.
  /// `promised` are absolute paths of data files that may still be missing.
  ///
  /// Where the specification has the key `plugins`, the libraries it names are loaded before anything is checked, so
  /// that their components count as known; the checked list holds their absolute paths. Throws FileError for one that
  /// cannot be loaded (Plugins.hpp). Collective.
  static Input read(const std::string& file, const std::vector<std::string>& overrides,
                    const Specification& specification, const Communicator& communicator,
                    const std::vector<std::string>& promised = {});

  const Teuchos::ParameterList& list() const { return list_; }
  const std::string& file() const { return file_; }
  /// Absolute paths of the YAML files it was read from, each with the XXH3 hash (128 bits) of its text.
  const std::vector<std::pair<std::string, std::string>>& text_files() const { return text_files_; }
  /// Absolute paths of the data files and the plugins the input names, and of the files promised.
  const std::vector<std::string>& data_files() const { return data_files_; }
  /// Where the entry stands, or its nearest enclosing block.
  Location location(const std::string& path) const;
  /// Puts "file:line:column: " before each problem: for mistakes that components find while they are built.
  InputError located(const InputError& error) const;
  /// The checked input with defaults, as YAML in SI units: what `kiln check` prints and provenance records.
  std::string merged() const;

 private:
  std::string file_;
  Teuchos::ParameterList list_;
  std::map<std::string, Location> locations_;
  std::vector<std::pair<std::string, std::string>> text_files_;
  std::vector<std::string> data_files_;
};

/// The checked block as YAML text, keys in their order; used for hashes and comparisons.
std::string to_yaml(const Teuchos::ParameterList& list);

}  // namespace kiln
