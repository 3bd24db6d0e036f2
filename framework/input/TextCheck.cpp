#include "framework/input/TextCheck.hpp"

#include <fmt/format.h>

#include "framework/base/Text.hpp"

namespace kiln {

bool check_text(const std::string& text, const Location& origin, Mistakes& mistakes) {
  int line = 1;
  std::size_t line_start = 0;
  bool in_indentation = true;
  const auto refuse = [&](std::size_t i, std::string found, std::string expected) {
    Location location = origin;
    if (origin.line != 0) location = {origin.file, line, static_cast<int>(i - line_start) + 1};
    mistakes.add(location, {{}, std::move(found), std::move(expected), {}});
    return false;
  };
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = character_length(text, i);
    if (length == 0) return refuse(i, fmt::format("byte 0x{:02x} is not UTF-8", byte), "YAML text in UTF-8");
    if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7f) {
      return refuse(i, fmt::format("control character 0x{:02x}", byte), "YAML text in UTF-8");
    }
    if (byte == '%' && i == line_start) {
      return refuse(i, "a line that begins with '%'", "no directives; a text that begins with '%' stands in quotes");
    }
    if (byte == '\n') {
      ++line;
      line_start = i + 1;
      in_indentation = true;
    } else if (byte == '\t' && in_indentation) {
      const std::size_t content = text.find_first_not_of(" \t\r", i);
      const bool blank = content == std::string::npos || text[content] == '\n' || text[content] == '#';
      if (!blank) return refuse(i, "a tab in the indentation", "spaces");
    } else if (byte != ' ') {
      in_indentation = false;
    }
    i += length;
  }
  return true;
}

}  // namespace kiln
