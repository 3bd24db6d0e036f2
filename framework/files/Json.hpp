#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kiln {

/// The text as JSON; a discarded value (is_discarded()) for what is no JSON, and for what is nested so deeply that
/// walking through it could exhaust the stack.
nlohmann::json parse_json(const std::string& text);

/// The text of a JSON value, on one line or, with an `indent`, on many. What is no UTF-8, as the name of a file may be,
/// comes with U+FFFD in its place.
std::string json_text(const nlohmann::json& value, int indent = -1);

}  // namespace kiln
