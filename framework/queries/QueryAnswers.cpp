#include "framework/queries/QueryAnswers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "framework/base/Collectives.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/CsvLog.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Json.hpp"

namespace kiln {
namespace {

constexpr double not_written = std::numeric_limits<double>::quiet_NaN();

template <class Value>
std::vector<long long> each(const std::vector<PointOutcome>& outcomes, const Value& value) {
  std::vector<long long> values;
  for (const PointOutcome& outcome : outcomes) values.push_back(value(outcome));
  return values;
}

/// What is counted of every point, by its name in both files.
std::vector<std::pair<const char*, std::vector<long long>>> counts(const std::vector<PointOutcome>& outcomes) {
  return {{"steps", each(outcomes, [](const PointOutcome& o) { return o.steps; })},
          {"residuals", each(outcomes, [](const PointOutcome& o) { return o.residuals; })},
          {"iterations", each(outcomes, [](const PointOutcome& o) { return o.iterations; })},
          {"capped_steps", each(outcomes, [](const PointOutcome& o) { return o.capped_steps; })},
          {"diverged", each(outcomes, [](const PointOutcome& o) { return o.divergence.empty() ? 0 : 1; })}};
}

void write_file(const QueryAnswers& answers, const std::string& path,
                const std::map<std::string, std::string>& provenance,
                const Teuchos::RCP<const Communicator>& communicator) {
  const std::size_t points = answers.points.count(), own = answers.outcomes.size();
  const std::size_t probes = answers.probes.size(), components = answers.fields.size();
  hdf5::File file = hdf5::File::create(path, communicator);
  for (const auto& [name, value] : provenance) file.attribute(name, value);
  file.write("time", answers.times);
  file.attribute_of("time", "unit", "s");
  file.write("step", answers.steps);
  hdf5::Group parameters = file.create_group("parameters");
  for (std::size_t k = 0; k < answers.points.names.size(); ++k) {
    std::vector<double> values;
    for (const std::vector<double>& point : answers.points.values) values.push_back(point[k]);
    parameters.write(answers.points.names[k], values);
    parameters.attribute_of(answers.points.names[k], "unit", answers.units[k]);
  }
  for (const auto& [name, values] : counts(answers.outcomes)) {
    file.create_integers(name, {points}, -1);
    file.write_block(name, {answers.first}, {own}, values);
  }
  for (std::size_t c = 0; c < components; ++c) {
    const Field& field = answers.fields[c];
    std::vector<double> values;
    for (std::size_t i = c; i < answers.histories.size(); i += components) values.push_back(answers.histories[i]);
    file.create_reals(field.name, {points, answers.steps.size(), probes}, not_written);
    file.write_block(field.name, {answers.first, 0, 0}, {own, answers.steps.size(), probes}, values);
    file.attribute_of(field.name, "unit", field.unit);
    file.attribute_of(field.name, "axes", "point, time, probe");
    file.attribute_of(field.name, "probes", json_text(answers.probes));
  }
  file.flush();
}

std::vector<std::string> columns(const QueryAnswers& answers) {
  std::vector<std::string> columns{"point"};
  for (std::size_t k = 0; k < answers.units.size(); ++k) {
    columns.push_back(fmt::format("{} [{}]", answers.points.names[k], answers.units[k]));
  }
  for (const std::string& probe : answers.probes) {
    for (const Field& field : answers.fields) {
      columns.push_back(fmt::format("{} {} highest [{}]", probe, field.name, field.unit));
      columns.push_back(fmt::format("{} {} highest at [s]", probe, field.name));
      columns.push_back(fmt::format("{} {} last [{}]", probe, field.name, field.unit));
    }
  }
  for (const auto& [name, values] : counts({})) columns.emplace_back(name);
  return columns;
}

std::vector<double> row_of(const QueryAnswers& answers, std::size_t own_point) {
  const std::size_t point = answers.first + own_point;
  std::vector<double> row{static_cast<double>(point)};
  row.insert(row.end(), answers.points.values[point].begin(), answers.points.values[point].end());
  for (std::size_t column = 0; column < answers.width(); ++column) {
    double highest = not_written, at = not_written;
    for (std::size_t n = 0; n < answers.steps.size(); ++n) {
      const double value = answers.row(own_point, n)[column];
      if (std::isnan(value) || value <= highest) continue;
      highest = value;
      at = answers.times[n];
    }
    row.insert(row.end(), {highest, at, answers.row(own_point, answers.steps.size() - 1)[column]});
  }
  for (const auto& [name, values] : counts({answers.outcomes[own_point]})) {
    row.push_back(static_cast<double>(values.front()));
  }
  return row;
}

/// The table's text. Collective.
std::string table(const QueryAnswers& answers, const Communicator& communicator) {
  std::vector<std::string> names = columns(answers);
  for (std::string& name : names) name = csv_cell(name);
  std::string own;
  for (std::size_t point = 0; point < answers.outcomes.size(); ++point) {
    own += fmt::format("{}\n", fmt::join(row_of(answers, point), ","));
  }
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const std::string& rows : gathered(communicator, own)) text += rows;
  return text;
}

}  // namespace

void write_answers(const QueryAnswers& answers, const std::filesystem::path& folder,
                   const std::map<std::string, std::string>& provenance,
                   const Teuchos::RCP<const Communicator>& communicator) {
  AtomicPath path(folder / "queries.h5", communicator);
  write_file(answers, path.temporary(), provenance, communicator);
  path.commit();
  write_atomically(folder / "queries.csv", table(answers, *communicator), communicator);
}

}  // namespace kiln
