#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kiln {

/// The text as JSON; a discarded value (is_discarded()) for what is no JSON, and for what is nested so deeply that
/// walking through it could exhaust the stack.
nlohmann::json parse_json(const std::string& text);

}  // namespace kiln
