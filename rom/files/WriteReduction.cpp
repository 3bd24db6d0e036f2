#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "framework/base/Collectives.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Seal.hpp"
#include "framework/report/Provenance.hpp"
#include "rom/files/ParticleRows.hpp"
#include "rom/files/Reduction.hpp"
#include "rom/files/ReductionIdentity.hpp"
#include "rom/files/TrainedRange.hpp"

namespace kiln {
namespace {

/// Ids that any rank holds, ascending and once each, on every rank.
std::vector<GlobalIndex> all_ids(const Map& map) {
  std::vector<GlobalIndex> ids(local_size(map));
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = map.getGlobalElement(static_cast<LocalIndex>(i));
  ids = concatenated(*map.getComm(), ids);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

hdf5::Array<double> row_major(const MatrixView& matrix) {
  hdf5::Array<double> array{{matrix.extent(0), matrix.extent(1)}, {}};
  for (std::size_t i = 0; i < matrix.extent(0); ++i) {
    for (std::size_t j = 0; j < matrix.extent(1); ++j) array.values.push_back(matrix(i, j));
  }
  return array;
}

void write_basis(hdf5::Group group, const Map& rows, const Pod& basis, int components) {
  group.write_rows("modes", rows, fold(basis.modes, components));
  group.write("singular_values", basis.singular_values);
  group.attribute("rank", static_cast<long long>(basis.truncation.rank));
  group.attribute("energy", basis.truncation.energy);
}

void write_sample_mesh(hdf5::Group group, const WindowReduction& window, const std::vector<GlobalIndex>& sources) {
  group.write("rows", std::vector<long long>(window.sampled.begin(), window.sampled.end()));
  group.write("sources", std::vector<long long>(sources.begin(), sources.end()));
  group.write("gappy_operator", row_major(window.gappy_operator.matrix));
  group.write("residual_singular_values", window.residual_basis.singular_values);
  group.attribute("residual_rank", static_cast<long long>(window.residual_basis.truncation.rank));
  group.attribute("residual_energy", window.residual_basis.truncation.energy);
  group.attribute("sigma_min", window.gappy_operator.smallest_singular_value);
  group.attribute("condition", window.gappy_operator.condition);
  hdf5::Group model = group.create_group("model");
  window.sample->save_sample(model);
}

/// The least distance of a particle of the table to any other one of the model, in m; 0 where it stands alone.
double spacing_of(const ParticleTable& held, const Model& model) {
  const Map& rows = *model.rows();
  const auto positions = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), model.positions());
  double mine = std::numeric_limits<double>::infinity(), least = mine;
  for (std::size_t k = 0; k < held.ids.size(); ++k) {
    const double* from = held.positions.data() + 3 * k;
    const LocalIndex itself = rows.getLocalElement(held.ids[k]);
    for (LocalIndex i = 0; i < local_size(rows); ++i) {
      const double x = positions(i, 0) - from[0], y = positions(i, 1) - from[1], z = positions(i, 2) - from[2];
      if (i != itself) mine = std::min(mine, x * x + y * y + z * z);
    }
  }
  Teuchos::reduceAll(*rows.getComm(), Teuchos::REDUCE_MIN, 1, &mine, &least);
  return std::isfinite(least) ? std::sqrt(least) : 0.0;
}

void write_contents(const std::string& file, const Reduction& reduction) {
  const Map& rows = *reduction.model.rows();
  const Teuchos::RCP<const Communicator> communicator = rows.getComm();
  const int components = static_cast<int>(reduction.model.fields().size());
  const MatrixView reference(reduction.reference.data(), reduction.reference.extent(0), 1);
  hdf5::File root = hdf5::File::create(file, communicator);
  reduction_identity::write(root, reduction.input, reduction.model.parameters(), reduction.data_hashes);
  root.attribute("provenance", json_text(provenance(*communicator)));
  root.attribute("components", static_cast<long long>(components));
  root.attribute("particles", static_cast<long long>(rows.getGlobalNumElements()));
  root.write_rows("reference", rows, fold(reference, components));
  root.attribute_of("reference", "unit", reduction.model.fields().front().unit);

  hdf5::Group windows = root.create_group("windows");
  std::vector<GlobalIndex> told = reduction.questions.nearest;
  told.insert(told.end(), reduction.extremes.begin(), reduction.extremes.end());
  std::set<GlobalIndex> held(told.begin(), told.end()), targets = held;
  bool clustered = false;
  std::vector<MatrixView> modes;
  for (std::size_t w = 0; w < reduction.windows.size(); ++w) {
    const WindowReduction& window = reduction.windows[w];
    hdf5::Group group = windows.create_group(std::to_string(w));
    group.attribute("end", window.end);
    write_basis(group.create_group("basis"), rows, window.basis, components);
    const std::vector<GlobalIndex> sources = all_ids(*window.sample->sources());
    write_sample_mesh(group.create_group("sample_mesh"), window, sources);
    if (window.clustered) window.clustered->write(group.create_group("clusters"));
    modes.push_back(window.basis.modes);
    held.insert(sources.begin(), sources.end());
    targets.insert(window.sampled.begin(), window.sampled.end());
    clustered = clustered || window.clustered;
  }
  const auto table_of = [&](const std::set<GlobalIndex>& ids) {
    return ParticleTable::gather({ids.begin(), ids.end()}, rows, reduction.model.positions(), reduction.reference,
                                 modes, components);
  };
  hdf5::Group particles = root.create_group("particles");
  const ParticleTable table = table_of(held);
  table.write(particles);
  if (clustered) {
    hdf5::Group group = root.create_group("targets");
    table_of(targets).write(group);
  }
  Questions questions = reduction.questions;
  questions.spacing = spacing_of(table, reduction.model);
  questions.write(particles);
  write_points(root, reduction.points);
  root.flush();
}

}  // namespace

void write_reduction(const std::string& file, const Reduction& reduction) {
  write_contents(file, reduction);
  hdf5::seal(file, *reduction.model.rows()->getComm());
}

}  // namespace kiln
