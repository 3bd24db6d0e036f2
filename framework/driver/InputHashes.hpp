#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/input/Input.hpp"

namespace kiln {

/// What an input is made of: the YAML files it was read from ("kind": "text") and the data files it names ("data"). Of
/// each one "file", and its hash: "xxh3" (128 bits), of a data file as hash_of_data(). The same on every rank.
/// Collective.
nlohmann::json input_hashes(const Input& input, const Communicator& communicator);

/// The data files among them, a line each: name without folders, and hash. Tells runs on the same data from others.
std::string data_identity(const nlohmann::json& hashes);

}  // namespace kiln
