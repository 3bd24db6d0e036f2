#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/model/SampleRows.hpp"
#include "physics/sph/DomainParts.hpp"
#include "physics/sph/HeatModel.hpp"

namespace kiln {
namespace {

/// Sources of chosen rows: the rows themselves, then every other one that `refers` to, ascending.
std::vector<GlobalIndex> ordered_sources(const std::vector<GlobalIndex>& rows, std::vector<GlobalIndex> refers) {
  std::sort(refers.begin(), refers.end());
  refers.erase(std::unique(refers.begin(), refers.end()), refers.end());
  std::vector<GlobalIndex> sources(rows);
  std::set_difference(refers.begin(), refers.end(), rows.begin(), rows.end(), std::back_inserter(sources));
  return sources;
}

/// Index of each id in a list that consists of `rows` ascending ids followed by other ascending ones.
LocalIndex place(const std::vector<GlobalIndex>& sources, std::size_t rows, GlobalIndex id) {
  const auto middle = sources.begin() + static_cast<std::ptrdiff_t>(rows);
  auto found = std::lower_bound(sources.begin(), middle, id);
  if (found == middle || *found != id) found = std::lower_bound(middle, sources.end(), id);
  return static_cast<LocalIndex>(found - sources.begin());
}

template <class T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> result;
  result.reserve(order.size());
  for (const std::size_t i : order) result.push_back(values[i]);
  return result;
}

}  // namespace

HeatDomain sampled_domain(const HeatDomain& domain, const std::vector<GlobalIndex>& rows) {
  const HostDomain from(domain);
  DomainParts parts;
  std::vector<LocalIndex> local_rows;
  for (const GlobalIndex id : checked_rows(rows, *domain.rows)) {
    const LocalIndex local = domain.rows->getLocalElement(id);
    if (local == Teuchos::OrdinalTraits<LocalIndex>::invalid()) continue;
    parts.rows.push_back(id);
    local_rows.push_back(local);
  }
  std::vector<GlobalIndex> refers;
  for (const LocalIndex row : local_rows) {
    for (std::size_t pair = from.offsets(row); pair < from.offsets(row + 1); ++pair) {
      refers.push_back(from.sources[from.neighbours(pair)]);
    }
  }
  parts.sources = ordered_sources(parts.rows, std::move(refers));
  std::vector<LocalIndex> renumbered(from.sources.size());
  for (std::size_t s = 0; s < parts.sources.size(); ++s) {
    const LocalIndex old = domain.sources->getLocalElement(parts.sources[s]);
    renumbered[old] = static_cast<LocalIndex>(s);
    parts.positions.push_back({from.positions(old, 0), from.positions(old, 1), from.positions(old, 2)});
    parts.masses.push_back(from.masses(old));
  }
  for (const LocalIndex row : local_rows) {
    parts.areas.push_back(from.areas(row));
    for (std::size_t pair = from.offsets(row); pair < from.offsets(row + 1); ++pair) {
      parts.neighbours.push_back(renumbered[from.neighbours(pair)]);
      parts.weights.push_back(from.weights(pair));
    }
    parts.offsets.push_back(parts.neighbours.size());
  }
  return assembled(parts, domain.rows->getComm());
}

void save_domain(const HeatDomain& domain, hdf5::Group& group) {
  const HostDomain local(domain);
  const Communicator& communicator = *domain.rows->getComm();
  static_assert(std::is_same_v<GlobalIndex, long long>);

  std::vector<double> local_areas(local.areas.data(), local.areas.data() + local.areas.extent(0));
  std::vector<GlobalIndex> local_counts;
  for (std::size_t row = 0; row < local.rows.size(); ++row) {
    local_counts.push_back(static_cast<GlobalIndex>(local.offsets(row + 1) - local.offsets(row)));
  }
  std::vector<GlobalIndex> local_neighbours;
  for (std::size_t pair = 0; pair < local.neighbours.extent(0); ++pair) {
    local_neighbours.push_back(local.sources[local.neighbours(pair)]);
  }
  const std::vector<double> local_weights(local.weights.data(), local.weights.data() + local.weights.extent(0));
  const auto rows = concatenated(communicator, local.rows);
  const auto areas = concatenated(communicator, local_areas);
  const auto counts = concatenated(communicator, local_counts);
  const auto neighbours = concatenated(communicator, local_neighbours);
  const auto weights = concatenated(communicator, local_weights);
  const std::vector<std::size_t> order = ascending(rows);

  std::vector<std::size_t> starts(rows.size());
  for (std::size_t row = 1; row < rows.size(); ++row) {
    starts[row] = starts[row - 1] + static_cast<std::size_t>(counts[row - 1]);
  }
  std::vector<long long> offsets = {0};
  std::vector<long long> ordered_neighbours;
  std::vector<double> ordered_weights;
  for (const std::size_t row : order) {
    const auto first = static_cast<std::ptrdiff_t>(starts[row]);
    const auto last = first + static_cast<std::ptrdiff_t>(counts[row]);
    ordered_neighbours.insert(ordered_neighbours.end(), neighbours.begin() + first, neighbours.begin() + last);
    ordered_weights.insert(ordered_weights.end(), weights.begin() + first, weights.begin() + last);
    offsets.push_back(static_cast<long long>(ordered_neighbours.size()));
  }
  group.write("rows", reordered(rows, order));
  group.write("heated_areas", reordered(areas, order));
  group.attribute_of("heated_areas", "unit", "m^2");
  group.write("offsets", offsets);
  group.write("neighbours", ordered_neighbours);
  group.write("weights", ordered_weights);
  group.attribute_of("weights", "unit", "m^-5");

  std::vector<double> local_places;
  for (std::size_t s = 0; s < local.sources.size(); ++s) {
    local_places.insert(local_places.end(), {local.positions(s, 0), local.positions(s, 1), local.positions(s, 2)});
  }
  const std::vector<double> local_masses(local.masses.data(), local.masses.data() + local.masses.extent(0));
  const auto sources = concatenated(communicator, local.sources);
  const auto places = concatenated(communicator, local_places);
  const auto masses = concatenated(communicator, local_masses);
  std::vector<std::size_t> source_order = ascending(sources);
  // Halos repeat what a neighbour rank holds.
  source_order.erase(std::unique(source_order.begin(), source_order.end(),
                                 [&](std::size_t a, std::size_t b) { return sources[a] == sources[b]; }),
                     source_order.end());
  hdf5::Array<double> positions{{source_order.size(), 3}, {}};
  for (const std::size_t s : source_order) {
    positions.values.insert(positions.values.end(), {places[3 * s], places[3 * s + 1], places[3 * s + 2]});
  }
  group.write("sources", reordered(sources, source_order));
  group.write("positions", positions);
  group.attribute_of("positions", "unit", "m");
  group.write("masses", reordered(masses, source_order));
  group.attribute_of("masses", "unit", "kg");
}

HeatDomain restored_domain(const hdf5::Group& group, const Teuchos::RCP<const Communicator>& communicator) {
  const std::vector<long long> rows = group.integers("rows", {0}).values;
  const std::vector<long long> sources = group.integers("sources", {0}).values;
  const std::vector<long long> offsets = group.integers("offsets", {rows.size() + 1}).values;
  const std::vector<long long> neighbours = group.integers("neighbours", {0}).values;
  const std::vector<double> weights = group.finite_reals("weights", {neighbours.size()}).values;
  const std::vector<double> areas = group.finite_reals("heated_areas", {rows.size()}).values;
  const std::vector<double> masses = group.finite_reals("masses", {sources.size()}).values;
  const std::vector<double> positions = group.finite_reals("positions", {sources.size(), 3}).values;
  const auto require = [&group](bool right, const char* name, const char* expected) {
    if (!right) throw FileError(group.file(), group.path() + "/" + name, "does not fit the sample", expected);
  };
  const auto rising = [](const std::vector<long long>& ids) {
    return !ids.empty() && ids.front() >= 0 &&
           std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<long long>()) == ids.end();
  };
  const auto positive = [](double value) { return value > 0.0; };
  require(rising(rows), "rows", "ascending ids from 0 on, at least one");
  require(rising(sources), "sources", "ascending ids from 0 on, at least one");
  require(std::all_of(masses.begin(), masses.end(), positive), "masses", "masses above 0");
  require(std::all_of(areas.begin(), areas.end(), [](double area) { return area >= 0.0; }), "heated_areas",
          "areas of at least 0");
  require(offsets.front() == 0 && std::is_sorted(offsets.begin(), offsets.end()) &&
              offsets.back() == static_cast<long long>(neighbours.size()),
          "offsets", "a rise from 0 to the number of neighbours");
  require(std::includes(sources.begin(), sources.end(), rows.begin(), rows.end()), "rows", "ids among the sources");
  for (const long long id : neighbours) {
    require(std::binary_search(sources.begin(), sources.end(), id), "neighbours", "ids among the sources");
  }

  // Block r ends at the first row that reaches its share of the pairs.
  const auto block_start = [&](int rank) {
    const double share = static_cast<double>(offsets.back()) * rank / communicator->getSize();
    const auto end = std::lower_bound(offsets.begin(), offsets.end(), share, [](long long offset, double wanted) {
      return static_cast<double>(offset) < wanted;
    });
    return static_cast<std::size_t>(end - offsets.begin());
  };
  const std::size_t first_row = communicator->getRank() == 0 ? 0 : block_start(communicator->getRank());
  const std::size_t last_row =
      communicator->getRank() + 1 == communicator->getSize() ? rows.size() : block_start(communicator->getRank() + 1);

  DomainParts parts;
  parts.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(first_row),
                    rows.begin() + static_cast<std::ptrdiff_t>(last_row));
  const auto first_pair = static_cast<std::ptrdiff_t>(offsets[first_row]);
  const auto last_pair = static_cast<std::ptrdiff_t>(offsets[last_row]);
  parts.sources = ordered_sources(
      parts.rows, std::vector<GlobalIndex>(neighbours.begin() + first_pair, neighbours.begin() + last_pair));
  for (const GlobalIndex id : parts.sources) {
    const auto s = static_cast<std::size_t>(std::lower_bound(sources.begin(), sources.end(), id) - sources.begin());
    parts.positions.push_back({positions[3 * s], positions[3 * s + 1], positions[3 * s + 2]});
    parts.masses.push_back(masses[s]);
  }
  for (std::size_t row = first_row; row < last_row; ++row) {
    parts.areas.push_back(areas[row]);
    parts.offsets.push_back(static_cast<std::size_t>(offsets[row + 1] - offsets[first_row]));
  }
  for (std::ptrdiff_t pair = first_pair; pair < last_pair; ++pair) {
    parts.neighbours.push_back(place(parts.sources, parts.rows.size(), neighbours[pair]));
  }
  parts.weights.assign(weights.begin() + first_pair, weights.begin() + last_pair);
  return assembled(parts, communicator);
}

namespace {

/// `range`: that of the model which the group is for.
MaterialTable restored_table(const TableRange& range, const hdf5::Group& group) {
  const hdf5::Group table = group.group("material");
  const hdf5::Array<double> values = table.finite_reals("properties", {0, 3});
  if (values.shape[0] < 2) {
    throw FileError(table.file(), table.path() + "/properties", "has fewer than 2 rows", "a table of properties");
  }
  const double from = table.finite_real("from"), step = table.finite_real("step");
  if (!(step > 0.0))
    throw FileError(table.file(), table.path() + " attribute 'step'", fmt::format("is {}", step), "above 0");
  if (from != range.from || step != range.step || static_cast<double>(values.shape[0]) != range.intervals() + 1.0) {
    throw FileError(
        table.file(), table.path() + "/properties",
        fmt::format("has {} rows from {} K in steps of {} K", values.shape[0], from, step),
        fmt::format("those from {} K to {} K in steps of {} K, as the model has", range.from, range.to, range.step));
  }
  if (!std::all_of(values.values.begin(), values.values.end(), [](double value) { return value > 0.0; })) {
    throw FileError(table.file(), table.path() + "/properties", "holds values that are not above 0",
                    "a table of properties");
  }
  return {from, step, values.values};
}

}  // namespace

std::unique_ptr<HeatModel> HeatModel::on(HeatDomain domain) const {
  auto model = std::unique_ptr<HeatModel>(new HeatModel(list_, table_, std::move(domain)));
  for (const Parameter& parameter : parameters_.list()) model->parameters_.set(parameter.name, *parameter.value);
  return model;
}

std::unique_ptr<Model> HeatModel::sampled(const std::vector<GlobalIndex>& rows) const {
  return on(sampled_domain(domain_, rows));
}

void HeatModel::save_sample(hdf5::Group& group) const {
  save_domain(domain_, group);
  hdf5::Group table = group.create_group("material");
  table.attribute("from", table_.from());
  table.attribute("step", table_.step());
  const std::vector<double> values = table_.values();
  table.write("properties", hdf5::Array<double>{{values.size() / 3, 3}, values});
  table.attribute_of("properties", "columns", "conductivity W/(m K), specific heat J/(kg K), density kg/m^3");
}

HeatModel::HeatModel(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group)
    : HeatModel(list, restored_table(TableRange::of(list), group), restored_domain(group, context.communicator)) {}

}  // namespace kiln
