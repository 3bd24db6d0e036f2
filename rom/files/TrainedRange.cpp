#include "rom/files/TrainedRange.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

constexpr const char* points_group = "points";
/// Relative to the value: what units and grids round.
constexpr double round_off = 1e-9;

std::string text(const TrainedRange& range) {
  return range.least == range.most ? fmt::format("{:.6g}", range.least)
                                   : fmt::format("{:.6g} to {:.6g}", range.least, range.most);
}

}  // namespace

void write_points(hdf5::Group& root, const ParameterPoints& points) {
  hdf5::Group group = root.create_group(points_group);
  for (std::size_t k = 0; k < points.names.size(); ++k) {
    std::vector<double> values;
    for (const std::vector<double>& point : points.values) values.push_back(point[k]);
    group.write(points.names[k], values);
  }
}

std::vector<TrainedRange> read_trained_ranges(const hdf5::Group& root) {
  const hdf5::Group group = root.group(points_group);
  std::vector<TrainedRange> ranges;
  for (const std::string& name : group.names()) {
    const std::vector<double> values = group.finite_reals(name, {0}).values;
    if (values.empty()) throw FileError(group.file(), group.path() + "/" + name, "holds no value", "one a point");
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    ranges.push_back({name, *least, *most});
  }
  return ranges;
}

std::string outside_of(const std::vector<TrainedRange>& ranges, const Parameters& parameters) {
  std::vector<std::string> outside;
  for (const Parameter& parameter : parameters.list()) {
    const auto range = std::find_if(ranges.begin(), ranges.end(),
                                    [&](const TrainedRange& known) { return known.name == parameter.name; });
    if (range == ranges.end()) continue;
    const double value = *parameter.value;
    const double slack = round_off * std::max(std::abs(range->least), std::abs(range->most));
    if (value >= range->least - slack && value <= range->most + slack) continue;
    const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
    outside.push_back(
        fmt::format("{} is {:.6g}{}, and {}{} in the training", parameter.name, value, unit, text(*range), unit));
  }
  if (outside.empty()) return {};
  return fmt::format("the errors that the training stated are not of these parameters: {}; try_on states them",
                     fmt::join(outside, "; "));
}

}  // namespace kiln
