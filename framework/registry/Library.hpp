#pragma once

#include <string>
#include <vector>

/// What set_library() of Registry.hpp begins: registrations of a plugin. A name that exists already throws nothing
/// meanwhile, since they run inside the system's loader, which no exception may cross.
namespace kiln::catalogue {

/// Ends them. Returns the names that existed already, each with both origins; if there are any, or loading the library
/// `failed` otherwise, none of its registrations is kept.
std::vector<std::string> end_library(bool failed);

}  // namespace kiln::catalogue
