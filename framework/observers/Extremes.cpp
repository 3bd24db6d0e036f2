#include "framework/observers/Extremes.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <limits>
#include <utility>

#include "framework/base/Loop.hpp"
#include "framework/files/CsvTable.hpp"
#include "framework/files/Together.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr const char* file_name = "extremes.csv";

/// Smallest and largest of the values first, first + stride, …; infinity and −infinity of none.
template <class View>
std::pair<double, double> range(const View& values, std::size_t first, std::size_t stride) {
  double smallest = infinity, largest = -infinity;
  const double* const data = values.data();
#pragma omp simd reduction(min : smallest) reduction(max : largest)
  for (std::size_t index = first; index < values.extent(0); index += stride) {
    smallest = data[index] < smallest ? data[index] : smallest;
    largest = data[index] > largest ? data[index] : largest;
  }
  return {smallest, largest};
}

/// Joins the ranks' pairs of value and particle, largest and smallest in turn, to those of all particles.
void join(const std::vector<const double*>& parts, std::vector<double>& numbers) {
  for (std::size_t which = 0; which < numbers.size() / 2; ++which) {
    const double sign = which % 2 == 0 ? 1.0 : -1.0;
    const double* best = parts[0] + 2 * which;
    for (const double* const part : parts) {
      const double* const other = part + 2 * which;
      // Equal values go to the lowest id, whichever rank holds it.
      if (sign * other[0] > sign * best[0] || (other[0] == best[0] && other[1] < best[1])) best = other;
    }
    std::copy_n(best, 2, numbers.begin() + static_cast<std::ptrdiff_t>(2 * which));
  }
}

}  // namespace

KILN_REGISTER(Observer, Extremes, "extremes", "highest and lowest value of each component over time: extremes.csv");

Specification Extremes::specification() {
  Specification specification;
  specification.integer("every", "steps between two rows").at_least(1).defaults_to(10);
  return specification;
}

Extremes::Extremes(const Teuchos::ParameterList& list, const Context& context)
    : context_(context),
      every_(list.get<int>("every")),
      fields_(context.method.fields()),
      state_("kiln::observers::state", context.method.positions().extent(0) * fields_.size()),
      state_host_(Kokkos::create_mirror_view(state_)) {}

std::vector<std::string> Extremes::columns() const {
  std::vector<std::string> columns{"step", "time [s]"};
  for (const Field& field : fields_) {
    for (const char* which : {"largest", "smallest"}) {
      columns.push_back(fmt::format("{} {} [{}]", which, field.name, field.unit));
      columns.push_back(fmt::format("particle of {} {}", which, field.name));
    }
  }
  return columns;
}

double Extremes::particle_with(double value, std::size_t component) const {
  for (std::size_t index = component; index < state_host_.extent(0); index += fields_.size()) {
    if (state_host_(index) != value) continue;
    return static_cast<double>(
        context_.method.particles()->getGlobalElement(static_cast<LocalIndex>(index / fields_.size())));
  }
  return -1.0;
}

std::vector<double> Extremes::local_extremes(const Moment& moment) {
  context_.method.state(moment.x, state_);
  copy_to_host(state_, state_host_);
  const std::size_t components = fields_.size();
  std::vector<double> extremes;
  for (std::size_t component = 0; component < components; ++component) {
    const auto [smallest, largest] = range(state_host_, component, components);
    for (const double value : {largest, smallest}) {
      extremes.push_back(value);
      extremes.push_back(particle_with(value, component));
    }
  }
  return extremes;
}

void Extremes::begin() {
  log_ = std::make_unique<CsvLog>(context_.folder / file_name, columns(), context_.first_step, 4 * fields_.size(), join,
                                  context_.communicator);
}

void Extremes::observe(const Moment& moment) {
  if (moment.step % every_ == 0 || moment.step == moment.last_step) {
    log_->add(moment.step, moment.time, local_extremes(moment));
  }
  if (moment.checkpoint) log_->flush();
}

void Extremes::finish(RunReport& report) {
  log_->flush();
  CsvTable table;
  const std::filesystem::path path = context_.folder / file_name;
  on_root(*context_.communicator, path.string(), [&]() -> std::optional<Fault> {
    table = read_csv(path);
    return std::nullopt;
  });
  nlohmann::json section = {{"every", every_}, {"particles", context_.method.particles()->getGlobalNumElements()}};
  if (context_.communicator->getRank() == 0) {
    for (std::size_t component = 0; component < fields_.size(); ++component) {
      nlohmann::json& entry = section[fields_[component].name];
      entry["unit"] = fields_[component].unit;
      for (std::size_t which = 0; which < 2; ++which) {
        const std::size_t column = 2 + 4 * component + 2 * which;
        const double sign = which == 0 ? 1.0 : -1.0;
        const std::vector<double>* best = nullptr;
        for (const std::vector<double>& row : table.rows) {
          if (best == nullptr || sign * row[column] > sign * (*best)[column]) best = &row;
        }
        if (best == nullptr) continue;
        const std::string name = which == 0 ? "largest" : "smallest";
        entry[name] = (*best)[column];
        entry[name + "_particle"] = static_cast<long long>((*best)[column + 1]);
        entry[name + "_time_s"] = (*best)[1];
      }
    }
  }
  report.section("observers")["extremes"] = section;
}

}  // namespace kiln
