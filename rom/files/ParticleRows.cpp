#include "rom/files/ParticleRows.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <optional>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "rom/linear_algebra/Dense.hpp"

namespace kiln {
namespace {

/// Rows `ids` of a matrix spread by `map`, on every rank, row-major.
hdf5::Array<double> gather_rows(const std::vector<GlobalIndex>& ids, const Map& map, const ConstMatrixView& local) {
  const std::size_t columns = local.extent(1);
  hdf5::Array<double> result{{ids.size(), columns}, std::vector<double>(ids.size() * columns, 0.0)};
  const auto owned = local_size(map);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const LocalIndex row = map.getLocalElement(ids[i]);
    if (row < 0 || row >= owned) continue;
    for (std::size_t k = 0; k < columns; ++k) result.values[i * columns + k] = local(row, k);
  }
  sum_over_ranks(*map.getComm(), result.values.data(), result.values.size());
  return result;
}

}  // namespace

MatrixView fold(const MatrixView& entries, int components) {
  if (components == 1) return entries;
  const std::size_t particles = entries.extent(0) / components, columns = entries.extent(1);
  MatrixView result("kiln::rom::folded", particles, columns * components);
  for (std::size_t k = 0; k < columns; ++k) {
    for (int c = 0; c < components; ++c) {
      for (std::size_t i = 0; i < particles; ++i) result(i, k * components + c) = entries(i * components + c, k);
    }
  }
  return result;
}

MatrixView unfold(const MatrixView& particles, int components) {
  if (components == 1) return particles;
  const std::size_t count = particles.extent(0), columns = particles.extent(1) / components;
  MatrixView result("kiln::rom::unfolded", count * components, columns);
  for (std::size_t k = 0; k < columns; ++k) {
    for (int c = 0; c < components; ++c) {
      for (std::size_t i = 0; i < count; ++i) result(i * components + c, k) = particles(i, k * components + c);
    }
  }
  return result;
}

ParticleTable ParticleTable::gather(const std::vector<GlobalIndex>& ids, const Map& map, ConstPositionView positions,
                                    const VectorView& reference, const std::vector<MatrixView>& modes, int components) {
  ParticleTable table;
  table.ids = ids;
  table.components = components;
  const std::size_t owned = local_size(map);
  MatrixView columns("kiln::rom::positions", owned, 3);
  for (std::size_t i = 0; i < owned; ++i) {
    for (int d = 0; d < 3; ++d) columns(i, d) = positions(i, d);
  }
  table.positions = gather_rows(ids, map, columns).values;
  table.reference = gather_rows(ids, map, fold(MatrixView(reference.data(), reference.extent(0), 1), components));
  std::vector<hdf5::Array<double>> windows;
  std::size_t width = 0;
  for (const MatrixView& of_window : modes) {
    windows.push_back(gather_rows(ids, map, fold(of_window, components)));
    width += windows.back().shape[1];
  }
  table.modes.shape = {ids.size(), width};
  table.modes.values.reserve(ids.size() * width);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (const hdf5::Array<double>& window : windows) {
      const auto row = window.values.begin() + static_cast<std::ptrdiff_t>(i * window.shape[1]);
      table.modes.values.insert(table.modes.values.end(), row, row + static_cast<std::ptrdiff_t>(window.shape[1]));
    }
  }
  return table;
}

VectorView ParticleTable::reference_entries() const {
  VectorView entries("kiln::rom::reference", reference.values.size());
  std::copy(reference.values.begin(), reference.values.end(), entries.data());
  return entries;
}

MatrixView ParticleTable::mode_entries() const {
  const std::size_t width = modes.shape[1], columns = width / components;
  MatrixView entries("kiln::rom::modes", ids.size() * components, columns);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      for (int c = 0; c < components; ++c) {
        entries(i * components + c, k) = modes.values[i * width + k * components + c];
      }
    }
  }
  return entries;
}

void ParticleTable::write(hdf5::Group& group) const {
  group.write("ids", std::vector<long long>(ids.begin(), ids.end()));
  group.write("positions", hdf5::Array<double>{{ids.size(), 3}, positions});
  group.attribute_of("positions", "unit", "m");
  group.write("reference", reference);
  group.write("modes", modes);
}

ParticleTable ParticleTable::read(const hdf5::Group& group, std::vector<GlobalIndex> ids, int components, int modes) {
  ParticleTable table;
  table.ids = std::move(ids);
  table.components = components;
  const std::size_t count = table.ids.size();
  table.positions = group.finite_reals("positions", {count, 3}).values;
  table.reference = group.finite_reals("reference", {count, static_cast<std::size_t>(components)});
  table.modes = group.finite_reals("modes", {count, static_cast<std::size_t>(modes) * components});
  return table;
}

std::ptrdiff_t ParticleTable::find(GlobalIndex id) const {
  const auto place = std::lower_bound(ids.begin(), ids.end(), id);
  return place == ids.end() || *place != id ? -1 : place - ids.begin();
}

BasisRows rows_at(const Map& particles, const std::vector<const ParticleTable*>& tables, std::size_t columns,
                  const std::string& file) {
  const std::size_t components = tables.front()->components;
  const std::size_t count = local_size(particles);
  VectorView reference("kiln::rom::reference", count * components);
  MatrixView modes("kiln::rom::modes", count * components, columns);
  std::optional<Fault> fault;
  for (std::size_t i = 0; i < count; ++i) {
    const GlobalIndex id = particles.getGlobalElement(static_cast<LocalIndex>(i));
    const auto holder = std::find_if(tables.begin(), tables.end(),
                                     [id](const ParticleTable* candidate) { return candidate->find(id) >= 0; });
    if (holder == tables.end()) {
      fault = Fault{"", fmt::format("holds no basis row of particle {}", id), {}};
      break;
    }
    const ParticleTable& table = **holder;
    const std::size_t row = table.find(id), stride = table.modes.shape[1];
    for (std::size_t c = 0; c < components; ++c) {
      reference(i * components + c) = table.reference.values[row * components + c];
      for (std::size_t k = 0; k < columns; ++k) {
        modes(i * components + c, k) = table.modes.values[row * stride + k * components + c];
      }
    }
  }
  throw_together(*particles.getComm(), file, fault);
  return {reference, modes};
}

}  // namespace kiln
