#pragma once

#include <string>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// A table of all registered components: category, name, summary, and the library each came with.
std::string list_components();

/// Every component of that name: what it is, and a table of its keys with type, unit, default, range, choices and help,
/// keys of nested blocks indented. The name of a category lists its members. Throws InputError with the nearest known
/// name.
std::string describe(const std::string& name);
std::string describe(const Specification& specification, const std::string& title);

/// A YAML block with every key of the component and its help as comments: defaults stand as values, "# required: …"
/// marks what a user must fill in, keys that may be left out are commented out. What is filled in passes the checker.
/// Throws InputError with the nearest known name.
std::string template_of(const std::string& name);
std::string template_of(const Specification& specification, const std::string& title);

}  // namespace kiln
