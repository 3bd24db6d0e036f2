#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

/// Shared libraries that add components at run time. A plugin is code: one is loaded only if the input or the command
/// line names it, and stays loaded until Kiln ends.
namespace kiln::plugins {

struct Loaded {
  std::string file;    ///< absolute, links resolved
  std::string sha256;  ///< of its bytes, in hexadecimal digits
};

/// Every load() from now on throws.
void forbid();

/// Loads the library `name`, unless it is loaded already, so that its components are registered; returns where it was
/// found. A name without '/' is looked for in `folder`, in the folders of KILN_PLUGIN_PATH (separated by ':') and in
/// lib/kiln/plugins of the prefix Kiln is installed in; any other one is relative to `folder`. No other place
/// is searched.
///
/// Rank 0 finds the file; every rank loads it and makes sure that it is the same. `place` is where the plugin is named,
/// which begins the FileError (InputError when plugins are forbidden) that every rank throws alike if the library is
/// not found, is no plugin, was built against another Kiln, cannot be loaded, or registers a name that exists.
/// Collective.
std::string load(const std::string& name, const std::filesystem::path& folder, const std::string& place,
                 const Communicator& communicator);

/// In the order of loading.
const std::vector<Loaded>& loaded();

}  // namespace kiln::plugins
