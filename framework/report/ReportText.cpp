#include "framework/report/ReportText.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "framework/files/Json.hpp"

namespace kiln {
namespace {

struct Line {
  std::string name;
  std::string value;
};

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// Splits "wall_s" into "wall" and "s".
std::pair<std::string, std::string> name_and_unit(std::string key) {
  static const std::vector<std::pair<std::string, std::string>> endings = {
      {"_kelvin", "K"}, {"_watt", "W"}, {"_percent", "%"}, {"_bytes", "B"}, {"_s", "s"}, {"_m", "m"}};
  std::string unit;
  for (const auto& [ending, symbol] : endings) {
    if (ends_with(key, ending)) {
      key.resize(key.size() - ending.size());
      unit = symbol;
      break;
    }
  }
  if (key.rfind("ns_", 0) == 0) {
    key.erase(0, 3);
    unit = "ns";
  }
  std::replace(key.begin(), key.end(), '_', ' ');
  return {key, unit};
}

std::string size_text(double bytes) {
  static const char* const symbols[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t scale = 0;
  for (; bytes >= 1024.0 && scale + 1 < std::size(symbols); ++scale) bytes /= 1024.0;
  return fmt::format("{:.4g} {}", bytes, symbols[scale]);
}

std::string value_text(const nlohmann::json& value, const std::string& unit) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "not a number";
  if (unit == "B" && value.is_number()) return size_text(value.get<double>());
  std::string text;
  if (value.is_number_integer()) {
    text = json_text(value);
  } else if (value.is_number()) {
    text = fmt::format("{:.6g}", value.get<double>());
  } else {
    for (const nlohmann::json& entry : value) text += (text.empty() ? "" : ", ") + value_text(entry, "");
    text = "(" + text + ")";
  }
  return unit.empty() ? text : text + " " + unit;
}

bool is_plain_list(const nlohmann::json& value) {
  return value.is_array() &&
         std::none_of(value.begin(), value.end(), [](const nlohmann::json& e) { return e.is_structured(); });
}

bool is_several_lines(const nlohmann::json& value) {
  return value.is_string() && value.get_ref<const std::string&>().find('\n') != std::string::npos;
}

/// A number with its unit beside it: {"unit": "K", "highest": 2440.0} gives "highest [K]".
void add_lines(const std::string& prefix, const nlohmann::json& value, std::vector<Line>& lines,
               std::vector<std::string>& texts) {
  if (value.is_object()) {
    const auto told = value.find("unit");
    const std::string unit = told != value.end() && told->is_string() ? told->get<std::string>() : "";
    for (const auto& [key, entry] : value.items()) {
      if (key == "unit" && value.size() > 1) continue;
      const auto [name, own_unit] = name_and_unit(key);
      const std::string full = prefix.empty() ? name : prefix + ", " + name;
      if (entry.is_structured() && !is_plain_list(entry)) {
        add_lines(full, entry, lines, texts);
      } else if (is_several_lines(entry)) {
        texts.push_back(entry.get<std::string>());
      } else {
        lines.push_back({full, value_text(entry, own_unit.empty() && entry.is_number_float() ? unit : own_unit)});
      }
    }
    return;
  }
  if (value.is_array()) {
    std::size_t number = 0;
    for (const nlohmann::json& entry : value) {
      nlohmann::json rest = entry;
      std::string name = std::to_string(++number);
      if (entry.is_object() && entry.contains("name") && entry["name"].is_string()) {
        name = entry["name"].get<std::string>();
        rest.erase("name");
      }
      add_lines(prefix.empty() ? name : prefix + ", " + name, rest, lines, texts);
    }
    return;
  }
  lines.push_back({prefix, value_text(value, "")});
}

/// Characters as a terminal counts them.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string readable(const nlohmann::json& report) {
  struct Block {
    std::string title;
    std::vector<Line> lines;
    std::vector<std::string> texts;
  };
  std::vector<Block> blocks;
  std::size_t width = 0;
  for (const auto& [title, section] : report.items()) {
    Block& block = blocks.emplace_back(Block{name_and_unit(title).first, {}, {}});
    add_lines("", section, block.lines, block.texts);
    for (const Line& line : block.lines) width = std::max(width, width_of(line.name));
  }
  std::string text;
  for (const Block& block : blocks) {
    text += (text.empty() ? "" : "\n") + block.title + "\n";
    for (const Line& line : block.lines) {
      text += "  " + line.name + std::string(width - width_of(line.name), ' ') + "  " + line.value + "\n";
    }
    for (const std::string& table : block.texts) text += table + (table.back() == '\n' ? "" : "\n");
  }
  return text;
}

}  // namespace kiln
