#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/files/CompareNumbers.hpp"
#include "framework/files/CsvTable.hpp"
#include "framework/files/Json.hpp"

namespace kiln {
namespace {

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  nlohmann::json json = parse_json(text.str());
  if (json.is_discarded()) throw FileError(path.string(), "", "is no readable JSON");
  return json;
}

/// Two runs of the same thing never take the same time.
bool is_left_out(const std::string& key) {
  static const std::set<std::string> keys = {"provenance", "timing", "speedup"};
  const auto contains = [&key](const char* word) { return key.find(word) != std::string::npos; };
  return keys.count(key) > 0 || contains("wall_") || contains("cpu") || contains("memory");
}

class JsonComparison {
 public:
  JsonComparison(std::string label, NumberComparison& comparison) : label_(std::move(label)), comparison_(comparison) {}

  void compare(const nlohmann::json& a, const nlohmann::json& b, const std::string& path) {
    // JSON has no NaN: it is written as null.
    const bool number_a = a.is_number() || a.is_null(), number_b = b.is_number() || b.is_null();
    if (number_a && number_b) {
      if (a.is_null() && b.is_null()) return comparison_.fault(label_ + path + " is not a number on either side");
      comparison_.begin(label_ + path);
      comparison_.add(value(a), value(b), [&] { return path; });
    } else if (a.is_object() && b.is_object()) {
      compare_objects(a, b, path);
    } else if (a.is_array() && b.is_array()) {
      compare_arrays(a, b, path);
    } else if (a.type() != b.type()) {
      comparison_.fault(fmt::format("{}{} is {} and {}", label_, path, a.type_name(), b.type_name()));
    }
  }

 private:
  static double value(const nlohmann::json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
  }
  void compare_objects(const nlohmann::json& a, const nlohmann::json& b, const std::string& path) {
    std::set<std::string> keys;
    for (const auto& [key, entry] : a.items()) keys.insert(key);
    for (const auto& [key, entry] : b.items()) keys.insert(key);
    for (const std::string& key : keys) {
      if (is_left_out(key)) continue;
      const std::string full = path.empty() ? key : path + "." + key;
      if (!a.contains(key) || !b.contains(key)) {
        comparison_.one_sided(
            fmt::format("{}{} is missing on the {} side", label_, full, a.contains(key) ? "second" : "first"));
      } else {
        compare(a.at(key), b.at(key), full);
      }
    }
  }
  void compare_arrays(const nlohmann::json& a, const nlohmann::json& b, const std::string& path) {
    if (a.size() != b.size()) {
      return comparison_.one_sided(fmt::format("{}{} has {} and {} entries", label_, path, a.size(), b.size()));
    }
    for (std::size_t i = 0; i < a.size(); ++i) compare(a[i], b[i], fmt::format("{}[{}]", path, i));
  }

  std::string label_;
  NumberComparison& comparison_;
};

/// What tells one row of a table from the others: "line 7, particle = 5, x [m] = 0.001, …".
class RowPlaces {
 public:
  explicit RowPlaces(const CsvTable& table) : table_(table) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      if (is_place(table.columns[column])) columns_.push_back(column);
    }
    if (columns_.empty()) columns_.push_back(0);
  }
  static bool is_place(const std::string& column) {
    static const std::set<std::string> names = {"step", "time [s]", "particle", "x [m]", "y [m]", "z [m]"};
    return names.count(column) > 0;
  }
  std::string where(std::size_t row) const {
    std::string text = fmt::format("line {}", row + 2);
    for (const std::size_t column : columns_) {
      text += fmt::format(", {} = {:.6g}", table_.columns[column], table_.rows[row][column]);
    }
    return text;
  }

 private:
  const CsvTable& table_;
  std::vector<std::size_t> columns_;
};

}  // namespace

void compare_csv(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                 NumberComparison& comparison) {
  const CsvTable left = read_csv(a), right = read_csv(b);
  if (left.columns != right.columns && !comparison.common()) {
    return comparison.fault(fmt::format("{} and {} have different columns", a.string(), b.string()));
  }
  if (left.rows.size() != right.rows.size()) {
    return comparison.fault(
        fmt::format("{} has {} rows, {} has {}", a.string(), left.rows.size(), b.string(), right.rows.size()));
  }
  for (const std::string& column : right.columns) {
    if (std::find(left.columns.begin(), left.columns.end(), column) == left.columns.end()) {
      comparison.one_sided(fmt::format("{}{} is missing in {}", label, column, a.string()));
    }
  }
  const RowPlaces places(left);
  bool found_answer = false;
  for (std::size_t column = 0; column < left.columns.size(); ++column) {
    std::size_t other = column;
    if (left.columns != right.columns) {
      const auto same = std::find(right.columns.begin(), right.columns.end(), left.columns[column]);
      if (same == right.columns.end()) {
        comparison.one_sided(fmt::format("{}{} is missing in {}", label, left.columns[column], b.string()));
        continue;
      }
      other = same - right.columns.begin();
    }
    found_answer = found_answer || !RowPlaces::is_place(left.columns[column]);
    comparison.begin(label + left.columns[column]);
    for (std::size_t row = 0; row < left.rows.size(); ++row) {
      comparison.add(left.rows[row][column], right.rows[row][other], [&] { return places.where(row); });
    }
  }
  if (comparison.common() && !found_answer) {
    comparison.fault(label + "there is no column that both hold beside those that tell the rows");
  }
}

void compare_json(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& label,
                  NumberComparison& comparison) {
  JsonComparison(label, comparison).compare(read_json(a), read_json(b), "");
}

}  // namespace kiln
