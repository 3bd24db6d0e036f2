#include "framework/queries/QueryPoints.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/base/Nearest.hpp"
#include "framework/base/Units.hpp"
#include "framework/files/CsvTable.hpp"

namespace kiln {
namespace {

std::vector<std::string> names_of(const Parameters& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters.list()) names.push_back(parameter.name);
  return names;
}

const Parameter* find(const Parameters& parameters, const std::string& name) {
  const auto named = [&name](const Parameter& parameter) { return parameter.name == name; };
  const auto found = std::find_if(parameters.list().begin(), parameters.list().end(), named);
  return found == parameters.list().end() ? nullptr : &*found;
}

Problem unknown(const std::string& path, const std::string& name, const Parameters& parameters) {
  const std::vector<std::string> names = names_of(parameters);
  return {path, fmt::format("the model has no live parameter '{}'", name),
          names.empty() ? "a model with live parameters" : fmt::format("one of: {}", fmt::join(names, ", ")),
          nearest(name, names)};
}

std::string quantity_of(const Parameter& parameter) {
  if (parameter.unit == "1") return fmt::format("a number without a unit{}", parameter.range());
  return fmt::format("{} in {}{}", with_article(parse_unit(parameter.unit).dimension), parameter.unit,
                     parameter.range());
}

/// One value in SI units; adds what is wrong with it.
double value_in(const std::string& text, const Parameter& parameter, const std::string& path,
                std::vector<Problem>& problems) {
  try {
    const Quantity quantity = parse_quantity(text);
    const Dimension expected = parse_unit(parameter.unit).dimension;
    const bool fits = !quantity.has_unit || quantity.dimension == expected;
    const std::string trouble = fits ? parameter.trouble(quantity.value) : with_article(quantity.dimension);
    if (trouble.empty()) return quantity.value;
    problems.push_back({path, fmt::format("'{}' is {}", text, trouble), quantity_of(parameter), {}});
  } catch (const InputError& error) {
    problems.push_back({path, error.problems().front().found, quantity_of(parameter), {}});
  }
  return 0.0;
}

/// Values of each parameter.
struct Axes {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

constexpr std::size_t most_points = 1000000;

ParameterPoints combinations(const Axes& axes, const std::string& path) {
  std::size_t count = 1;
  for (const std::vector<double>& values : axes.values) {
    count *= values.size();
    if (count > most_points) {
      throw InputError(path + ".grid", fmt::format("gives more than {} combinations", most_points), "fewer values");
    }
  }
  ParameterPoints points{axes.names, {}};
  for (std::size_t point = 0; point < count; ++point) {
    std::vector<double> one(axes.values.size());
    std::size_t rest = point;
    for (std::size_t k = axes.values.size(); k-- > 0;) {
      one[k] = axes.values[k][rest % axes.values[k].size()];
      rest /= axes.values[k].size();
    }
    points.values.push_back(std::move(one));
  }
  return points;
}

ParameterPoints rows(const Axes& axes) {
  ParameterPoints points{axes.names, {}};
  for (std::size_t point = 0; point < axes.values.front().size(); ++point) {
    std::vector<double>& one = points.values.emplace_back();
    for (const std::vector<double>& values : axes.values) one.push_back(values[point]);
  }
  return points;
}

/// What is no number with whatever unit: told before the model is built, which knows the units.
void check_numbers(const Teuchos::ParameterList& points, std::vector<Problem>& problems) {
  for (auto entry = points.begin(); entry != points.end(); ++entry) {
    const std::string& name = points.name(entry);
    for (const std::string& text : texts_in(points, name)) {
      try {
        parse_quantity(text);
      } catch (const InputError& error) {
        problems.push_back({"points." + name, error.problems().front().found, "a number, with a unit or without", {}});
      }
    }
  }
}

Axes listed(const Teuchos::ParameterList& list, const Parameters& parameters, bool grid) {
  const std::string place = list.name();
  Axes axes;
  std::vector<Problem> problems;
  for (auto entry = list.begin(); entry != list.end(); ++entry) {
    const std::string& name = list.name(entry);
    const std::string path = fmt::format("{}.{}", place, name);
    const Parameter* parameter = find(parameters, name);
    if (parameter == nullptr) {
      problems.push_back(unknown(path, name, parameters));
      continue;
    }
    const std::vector<std::string> texts = texts_in(list, name);
    axes.names.push_back(name);
    std::vector<double>& values = axes.values.emplace_back();
    for (const std::string& text : texts) values.push_back(value_in(text, *parameter, path, problems));
    if (texts.empty()) problems.push_back({path, "an empty list is given", "one value or more", {}});
    if (!grid && values.size() != axes.values.front().size()) {
      problems.push_back({path,
                          fmt::format("lists {} values", values.size()),
                          fmt::format("{} of them, as {} has; or grid: true for all combinations",
                                      axes.values.front().size(), axes.names.front()),
                          {}});
    }
  }
  if (axes.names.empty() && problems.empty()) {
    problems.push_back({place, "lists no parameter", "values of one parameter or more", {}});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return axes;
}

/// Splits "heat_source.power [W]".
std::pair<std::string, std::optional<std::string>> name_and_unit(const std::string& column) {
  const std::size_t bracket = column.find('[');
  if (bracket == std::string::npos || column.back() != ']') return {column, std::nullopt};
  std::string name = column.substr(0, bracket);
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return {name, column.substr(bracket + 1, column.size() - bracket - 2)};
}

Axes tabulated(const std::string& file, const Parameters& parameters) {
  const CsvTable table = read_csv(file);
  if (table.rows.empty()) throw FileError(file, "", "has no row below its header", "a row for each point");
  Axes axes;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    const std::string place = fmt::format("column {}", column + 1);
    const auto [name, unit_text] = name_and_unit(table.columns[column]);
    const Parameter* parameter = find(parameters, name);
    if (parameter == nullptr) {
      const Problem problem = unknown("", name, parameters);
      throw FileError(file, place, problem.found, problem.expected);
    }
    if (std::find(axes.names.begin(), axes.names.end(), name) != axes.names.end()) {
      throw FileError(file, place, fmt::format("'{}' is an earlier column's name", name), "each parameter once");
    }
    Unit unit;
    unit.dimension = parse_unit(parameter->unit).dimension;
    if (unit_text) {
      try {
        unit = parse_unit(*unit_text);
      } catch (const InputError& error) {
        throw FileError(file, place, error.problems().front().found, quantity_of(*parameter));
      }
    }
    if (unit.dimension != parse_unit(parameter->unit).dimension) {
      throw FileError(file, place, fmt::format("{} [{}] is {}", name, *unit_text, with_article(unit.dimension)),
                      quantity_of(*parameter));
    }
    axes.names.push_back(name);
    std::vector<double>& values = axes.values.emplace_back();
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const double value = table.rows[row][column];
      // Through the text, so that a power of ten does not round twice.
      const std::string text = unit_text ? fmt::format("{} {}", value, *unit_text) : fmt::format("{}", value);
      const std::string at = fmt::format("point {}, {}", row, name);
      try {
        values.push_back(parse_quantity(text).value);
      } catch (const InputError& error) {
        throw FileError(file, at, error.problems().front().found, "a finite number");
      }
      if (const std::string trouble = parameter->trouble(values.back()); !trouble.empty()) {
        throw FileError(file, at, fmt::format("'{}' is {}", text, trouble), quantity_of(*parameter));
      }
    }
  }
  return axes;
}

}  // namespace

Specification points_specification() {
  Specification s;
  s.dictionary("points",
               "values of the model's live parameters, by name: a value for each point, e.g. {heat_source.power: "
               "[36 W, 40 W]}")
      .optional();
  s.file("file", "a table of points instead (CSV): a column a parameter, its name and perhaps [unit] on top")
      .optional();
  s.flag("grid", "all combinations of the values listed, the last parameter fastest; for `points`").defaults_to(false);
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    const bool points = list.isSublist("points"), file = list.isParameter("file");
    if (points) check_numbers(list.sublist("points"), problems);
    if (points == file) {
      problems.push_back({"",
                          points ? "both points and file are given" : "neither points nor file is given",
                          "one of points and file",
                          {}});
    }
    if (file && list.get<bool>("grid")) {
      problems.push_back({"grid", "goes with points, not with a file", "grid: false", {}});
    }
  });
  return s;
}

Specification query_specification() {
  Specification s = points_specification();
  s.integer("together", "points that advance together where the method offers it; 1: each has a run of its own")
      .at_least(1)
      .defaults_to(16);
  return s;
}

ParameterPoints points_of(const Teuchos::ParameterList& block, const Parameters& parameters) {
  const bool grid = block.get<bool>("grid");
  const Axes axes = block.isSublist("points") ? listed(block.sublist("points"), parameters, grid)
                                              : tabulated(block.get<std::string>("file"), parameters);
  return grid ? combinations(axes, block.name()) : rows(axes);
}

}  // namespace kiln
