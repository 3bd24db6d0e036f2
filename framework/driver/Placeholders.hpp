#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kiln {

/// Names and values that stand for {name} in texts, in the order of the file.
using PlaceholderValues = std::vector<std::pair<std::string, std::string>>;

/// The text with each {name} replaced by its value; "{{" and "}}" stand for braces. Throws InputError without a path
/// for a name that has no value (with the nearest known one) and for braces that do not match.
std::string fill_placeholders(const std::string& text, const PlaceholderValues& values);

/// All combinations of the values of several names, those of the last name changing fastest. No names: one, empty.
std::vector<PlaceholderValues> combinations(const std::vector<std::pair<std::string, std::vector<std::string>>>& names);

}  // namespace kiln
