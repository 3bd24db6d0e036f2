#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/input/Input.hpp"

namespace kiln {

/// Makes sure that an input file, which may come from anywhere, sends no results out of the folder Kiln was started in.
/// `key` is the entry that names the place of the results, `folders` are those that will be written: none may be
/// absolute or lead out by "..", and no symbolic link on the way to them or in them may. What the command line itself
/// says (--set) is the user's own word and always passes. Throws InputError, placed in the input. Collective.
void require_inside(const Input& input, const std::string& key, const std::vector<std::filesystem::path>& folders,
                    const Communicator& communicator);

}  // namespace kiln
