#include "framework/files/Compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "framework/base/Error.hpp"
#include "framework/files/CompareNumbers.hpp"

namespace kiln {
namespace {

namespace fs = std::filesystem;

/// The difference that nothing tolerates: a NaN, or infinity against a number.
constexpr double incomparable = std::numeric_limits<double>::infinity();

double relative_difference(double a, double b, double floor) {
  if (std::isnan(a) || std::isnan(b)) return incomparable;
  if (a == b) return 0.0;
  if (std::isinf(a) || std::isinf(b)) return incomparable;
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), floor});
}

void require_finite(double tolerance, double floor) {
  if (!std::isfinite(tolerance) || tolerance < 0.0 || !std::isfinite(floor) || floor < 0.0) {
    throw std::invalid_argument(
        fmt::format("compare: tolerance {} and floor {} must be finite and at least 0", tolerance, floor));
  }
}

bool is_comparable(const fs::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".h5" || kind == ".csv" || kind == ".json";
}

void compare_files(const fs::path& a, const fs::path& b, const std::string& label, NumberComparison& comparison) {
  const std::size_t compared = comparison.compared(), told = comparison.told();
  try {
    const std::string kind = a.extension().string();
    if (kind != b.extension().string()) {
      comparison.fault(fmt::format("{} and {} are files of different kinds", a.string(), b.string()));
    } else if (kind == ".h5") {
      compare_hdf5(a, b, label, comparison);
    } else if (kind == ".csv") {
      compare_csv(a, b, label, comparison);
    } else if (kind == ".json") {
      compare_json(a, b, label, comparison);
    } else {
      comparison.fault(fmt::format("{} is none of .h5, .csv, .json", a.string()));
    }
  } catch (const FileError& error) {
    comparison.unreadable(error.what());
  }
  if (comparison.compared() == compared && comparison.told() == told) {
    comparison.fault(fmt::format("nothing was compared of {} and {}", a.string(), b.string()));
  }
}

void compare_folders(const fs::path& a, const fs::path& b, NumberComparison& comparison) {
  std::set<std::string> names;
  for (const fs::path& folder : {a, b}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (is_comparable(entry.path())) names.insert(fs::relative(entry.path(), folder).string());
    }
  }
  for (const std::string& name : names) {
    const bool in_a = fs::exists(a / name), in_b = fs::exists(b / name);
    if (in_a && in_b) {
      compare_files(a / name, b / name, name + ":", comparison);
    } else {
      comparison.one_sided(fmt::format("{} is missing in {}", name, (in_a ? b : a).string()));
    }
  }
}

}  // namespace

void NumberComparison::begin(const std::string& field) {
  FieldDifference difference;
  difference.field = field;
  difference.tolerance = settings_.tolerance;
  difference.floor = settings_.floor;
  const auto own = std::find_if(settings_.own.begin(), settings_.own.end(),
                                [&field](const FieldTolerance& each) { return each.matches(field); });
  if (own != settings_.own.end()) {
    used_[own - settings_.own.begin()] = true;
    difference.tolerance = own->tolerance;
    difference.floor = own->floor;
  }
  result_.fields.push_back(std::move(difference));
}

void NumberComparison::add(double a, double b, const std::function<std::string()>& where) {
  FieldDifference& field = result_.fields.back();
  const double difference = relative_difference(a, b, field.floor);
  ++field.compared;
  if (difference > field.tolerance) ++field.failed;
  if (difference > field.worst) {
    field.worst = difference;
    field.a = a;
    field.b = b;
    field.where = where();
  }
}

void NumberComparison::fault_unused_tolerances() {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (used_[i]) continue;
    fault(fmt::format("no field is called '{}', or all that are have an earlier tolerance", settings_.own[i].fields));
  }
}

std::size_t CompareResult::compared() const {
  std::size_t sum = 0;
  for (const FieldDifference& field : fields) sum += field.compared;
  return sum;
}

bool CompareResult::same() const {
  const auto agrees = [](const FieldDifference& field) { return field.failed == 0; };
  return faults.empty() && compared() > 0 && std::all_of(fields.begin(), fields.end(), agrees);
}

std::string CompareResult::text() const {
  std::size_t width = 0;
  for (const FieldDifference& field : fields) width = std::max(width, field.field.size());
  std::string text;
  for (const FieldDifference& field : fields) {
    text += fmt::format("{} {:<{}}  {} numbers", field.failed == 0 ? "same " : "DIFFERS", field.field, width,
                        field.compared);
    if (field.failed > 0) text += fmt::format(", {} beyond {:g}", field.failed, field.tolerance);
    if (field.worst > 0.0) {
      text += fmt::format("; worst {:.3g} relative: {} and {} at {}", field.worst, field.a, field.b, field.where);
    }
    text += "\n";
  }
  for (const std::string& text_of_one : one_sided) text += "ALONE " + text_of_one + "\n";
  for (const std::string& fault : faults) text += "FAULT " + fault + "\n";
  if (compared() == 0) text += "FAULT nothing was compared\n";
  return text + fmt::format("{}: {} numbers compared\n", same() ? "same" : "different", compared());
}

CompareResult compare(const fs::path& a, const fs::path& b, const CompareSettings& settings) {
  require_finite(settings.tolerance, settings.floor);
  for (const FieldTolerance& each : settings.own) require_finite(each.tolerance, each.floor);
  CompareResult result;
  NumberComparison comparison(settings, result);
  for (const fs::path& side : {a, b}) {
    if (!fs::exists(side)) comparison.fault(side.string() + " is missing");
  }
  if (!result.faults.empty()) return result;
  if (fs::is_directory(a) != fs::is_directory(b)) {
    comparison.fault(fmt::format("{} is a folder, {} is a file", (fs::is_directory(a) ? a : b).string(),
                                 (fs::is_directory(a) ? b : a).string()));
  } else if (fs::is_directory(a)) {
    compare_folders(a, b, comparison);
  } else {
    compare_files(a, b, "", comparison);
  }
  if (result.faults.empty()) comparison.fault_unused_tolerances();
  return result;
}

}  // namespace kiln
