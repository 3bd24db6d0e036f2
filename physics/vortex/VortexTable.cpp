#include "physics/vortex/VortexTable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"

namespace kiln {
namespace {

/// Index of an id in an ascending list, or its length.
std::size_t find(const std::vector<GlobalIndex>& ids, GlobalIndex id) {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  return found != ids.end() && *found == id ? static_cast<std::size_t>(found - ids.begin()) : ids.size();
}

/// Rows in ascending order; each is one of the table's and there once.
std::vector<GlobalIndex> checked_rows(const VortexTable& table, std::vector<GlobalIndex> rows) {
  std::sort(rows.begin(), rows.end());
  const auto twice = std::adjacent_find(rows.begin(), rows.end());
  if (twice != rows.end()) {
    throw InputError("", fmt::format("particle {} is sampled twice", *twice), "each particle once");
  }
  for (const GlobalIndex id : rows) table.row(id);
  return rows;
}

void require_fit(bool fits, const std::string& found, const std::string& expected) {
  if (!fits) throw InputError("", "clusters of vortices: " + found, expected);
}

void check_clusters(const VortexTable& table, const SourceClusters& clusters) {
  require_fit(clusters.row_offsets.size() == clusters.rows.size() + 1 && clusters.row_offsets.front() == 0 &&
                  std::is_sorted(clusters.row_offsets.begin(), clusters.row_offsets.end()) &&
                  clusters.row_offsets.back() == clusters.row_clusters.size() &&
                  clusters.row_weights.size() == clusters.row_clusters.size(),
              "row_offsets, row_clusters and row_weights differ in length", "a list for each of the rows");
  require_fit(!clusters.member_offsets.empty() && clusters.member_offsets.front() == 0 &&
                  std::is_sorted(clusters.member_offsets.begin(), clusters.member_offsets.end()) &&
                  clusters.member_offsets.back() == clusters.members.size() &&
                  clusters.shares.size() == clusters.members.size(),
              "member_offsets, members and shares differ in length", "members for each cluster");
  for (const std::size_t cluster : clusters.row_clusters) {
    require_fit(cluster < clusters.clusters(), fmt::format("a row sums over cluster {}", cluster),
                fmt::format("one of the {}", clusters.clusters()));
  }
  for (const GlobalIndex member : clusters.members) table.source(member);
}

}  // namespace

std::size_t VortexTable::row(GlobalIndex id) const {
  const std::size_t found = find(rows, id);
  if (found < rows.size()) return found;
  throw InputError("", fmt::format("particle {} is no row of the model", id),
                   fmt::format("ids of the model's {} rows", rows.size()));
}

std::size_t VortexTable::source(GlobalIndex id) const {
  const std::size_t found = find(sources, id);
  if (found < sources.size()) return found;
  throw InputError("", fmt::format("particle {} is no source of the model", id),
                   fmt::format("ids of the model's {} sources", sources.size()));
}

VortexTable whole_table(const VortexCloud& cloud, const std::string& path) {
  VortexTable table;
  table.particles = static_cast<GlobalIndex>(cloud.x.size());
  if (cloud.x.empty()) throw InputError(path, "there is no particle", "at least 1");
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    if (!std::isfinite(cloud.x[i]) || !std::isfinite(cloud.y[i])) {
      throw InputError(path, fmt::format("particle {} lies at ({:.6g}, {:.6g}) m", i, cloud.x[i], cloud.y[i]),
                       "finite coordinates");
    }
    if (!std::isfinite(cloud.circulation[i])) {
      throw InputError(path, fmt::format("particle {} has the circulation {} m^2/s", i, cloud.circulation[i]),
                       "a finite circulation");
    }
  }
  table.rows.resize(cloud.x.size());
  std::iota(table.rows.begin(), table.rows.end(), GlobalIndex{0});
  table.sources = table.rows;
  table.x = cloud.x;
  table.y = cloud.y;
  table.circulations = cloud.circulation;
  return table;
}

VortexTable sampled_table(const VortexTable& table, const std::vector<GlobalIndex>& rows) {
  VortexTable sample = table;
  sample.rows = checked_rows(table, rows);
  return sample;
}

VortexTable clustered_table(const VortexTable& table, const SourceClusters& clusters) {
  check_clusters(table, clusters);
  require_fit(std::is_sorted(clusters.rows.begin(), clusters.rows.end()), "rows are in no order", "ascending ids");
  VortexTable result;
  result.particles = table.particles;
  result.rows = checked_rows(table, clusters.rows);

  std::map<GlobalIndex, std::size_t> used;
  for (const std::size_t cluster : clusters.row_clusters) {
    used.emplace(clusters.source_id(cluster, table.particles), cluster);
  }
  for (const GlobalIndex id : result.rows) {
    const std::size_t place = table.source(id);
    result.sources.push_back(id);
    result.x.push_back(table.x[place]);
    result.y.push_back(table.y[place]);
  }
  for (const auto& [id, cluster] : used) {
    if (std::binary_search(result.rows.begin(), result.rows.end(), id)) continue;
    double x = 0.0, y = 0.0;
    for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
      const std::size_t place = table.source(clusters.members[m]);
      x += clusters.shares[m] * table.x[place];
      y += clusters.shares[m] * table.y[place];
    }
    result.sources.push_back(id);
    result.x.push_back(x);
    result.y.push_back(y);
  }

  result.offsets.push_back(0);
  std::vector<std::pair<GlobalIndex, double>> list;
  for (std::size_t r = 0; r < result.rows.size(); ++r) {
    list.clear();
    for (std::size_t pair = clusters.row_offsets[r]; pair < clusters.row_offsets[r + 1]; ++pair) {
      list.emplace_back(clusters.source_id(clusters.row_clusters[pair], table.particles), clusters.row_weights[pair]);
    }
    // Neighbours in memory are read together.
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [id, circulation] : list) {
      result.listed.push_back(id);
      result.listed_circulations.push_back(circulation);
    }
    result.offsets.push_back(result.listed.size());
  }
  return result;
}

PairWeights vortex_pair_weights(const VortexTable& table, const std::vector<GlobalIndex>& rows) {
  PairWeights pairs;
  pairs.rows = checked_rows(table, rows);
  pairs.offsets.push_back(0);
  for (const GlobalIndex id : pairs.rows) {
    for (std::size_t j = 0; j < table.sources.size(); ++j) {
      if (table.sources[j] == id) continue;
      pairs.sources.push_back(table.sources[j]);
      pairs.weights.push_back(table.circulations[j]);
    }
    pairs.offsets.push_back(pairs.sources.size());
  }
  return pairs;
}

void save_table(const VortexTable& table, hdf5::Group& group) {
  static_assert(std::is_same_v<GlobalIndex, long long>);
  group.attribute("particles", table.particles);
  group.write("rows", table.rows);
  group.write("sources", table.sources);
  hdf5::Array<double> positions{{table.sources.size(), 2}, {}};
  for (std::size_t j = 0; j < table.sources.size(); ++j) {
    positions.values.insert(positions.values.end(), {table.x[j], table.y[j]});
  }
  group.write("positions", positions);
  group.attribute_of("positions", "unit", "m");
  if (table.has_lists()) {
    group.write("offsets", std::vector<long long>(table.offsets.begin(), table.offsets.end()));
    group.write("listed", table.listed);
    group.write("listed_circulations", table.listed_circulations);
    group.attribute_of("listed_circulations", "unit", "m^2/s");
  } else {
    group.write("circulations", table.circulations);
    group.attribute_of("circulations", "unit", "m^2/s");
  }
}

VortexTable restored_table(const hdf5::Group& group) {
  const auto require = [&group](bool right, const char* name, const char* expected) {
    if (!right) throw FileError(group.file(), group.path() + "/" + name, "does not fit the sample", expected);
  };
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  const auto ascending = [](const std::vector<GlobalIndex>& ids) {
    return std::is_sorted(ids.begin(), ids.end()) && std::adjacent_find(ids.begin(), ids.end()) == ids.end();
  };
  VortexTable table;
  table.particles = group.integer("particles");
  table.rows = group.integers("rows", {0}).values;
  table.sources = group.integers("sources", {0}).values;
  require(ascending(table.rows), "rows", "ascending ids");
  require(ascending(table.sources), "sources", "ascending ids");
  require(std::includes(table.sources.begin(), table.sources.end(), table.rows.begin(), table.rows.end()), "rows",
          "ids among the sources");
  const std::vector<double> positions = group.reals("positions", {table.sources.size(), 2}).values;
  require(finite(positions), "positions", "finite numbers");
  for (std::size_t j = 0; j < table.sources.size(); ++j) {
    table.x.push_back(positions[2 * j]);
    table.y.push_back(positions[2 * j + 1]);
  }
  if (group.has("circulations")) {
    table.circulations = group.reals("circulations", {table.sources.size()}).values;
    require(finite(table.circulations), "circulations", "finite numbers");
    return table;
  }
  const std::vector<long long> offsets = group.integers("offsets", {table.rows.size() + 1}).values;
  table.listed = group.integers("listed", {0}).values;
  table.listed_circulations = group.reals("listed_circulations", {table.listed.size()}).values;
  require(offsets.front() == 0 && std::is_sorted(offsets.begin(), offsets.end()) &&
              offsets.back() == static_cast<long long>(table.listed.size()),
          "offsets", "a rise from 0 to the number of pairs");
  for (const GlobalIndex id : table.listed) {
    require(find(table.sources, id) < table.sources.size(), "listed", "ids among the sources");
  }
  require(finite(table.listed_circulations), "listed_circulations", "finite numbers");
  table.offsets.assign(offsets.begin(), offsets.end());
  return table;
}

}  // namespace kiln
