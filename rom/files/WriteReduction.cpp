#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/files/AtomicFile.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/report/Provenance.hpp"
#include "rom/files/ParticleRows.hpp"
#include "rom/files/Reduction.hpp"
#include "rom/files/ReductionIdentity.hpp"

namespace kiln {
namespace {

/// Ids that any rank holds, ascending and once each, on every rank.
std::vector<GlobalIndex> all_ids(const Map& map) {
  const Communicator& communicator = *map.getComm();
  const std::size_t local = map.getMyGlobalIndices().extent(0);
  const int mine = static_cast<int>(local);
  int longest = mine;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &mine, &longest);
  constexpr GlobalIndex none = -1;
  std::vector<GlobalIndex> padded(longest, none), ids(static_cast<std::size_t>(longest) * communicator.getSize());
  for (std::size_t i = 0; i < local; ++i) padded[i] = map.getGlobalElement(static_cast<LocalIndex>(i));
  Teuchos::gatherAll(communicator, longest, padded.data(), static_cast<int>(ids.size()), ids.data());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  if (!ids.empty() && ids.front() == none) ids.erase(ids.begin());
  return ids;
}

hdf5::Array<double> row_major(const MatrixView& matrix) {
  hdf5::Array<double> array{{matrix.extent(0), matrix.extent(1)}, {}};
  for (std::size_t i = 0; i < matrix.extent(0); ++i) {
    for (std::size_t j = 0; j < matrix.extent(1); ++j) array.values.push_back(matrix(i, j));
  }
  return array;
}

void write_basis(hdf5::Group group, const Reduction& reduction, const MatrixView& reference, int components) {
  const Map& rows = *reduction.model.rows();
  group.write_rows("reference", rows, fold(reference, components));
  group.attribute_of("reference", "unit", reduction.model.fields().front().unit);
  group.write_rows("modes", rows, fold(reduction.basis.modes, components));
  group.write("singular_values", reduction.basis.singular_values);
  group.attribute("rank", static_cast<long long>(reduction.basis.truncation.rank));
  group.attribute("energy", reduction.basis.truncation.energy);
}

void write_sample_mesh(hdf5::Group group, const Reduction& reduction, const MatrixView& reference, int components) {
  group.write("rows", std::vector<long long>(reduction.sampled.begin(), reduction.sampled.end()));
  ParticleTable::gather(all_ids(*reduction.sample.sources()), *reduction.model.rows(), reduction.model.positions(),
                        reference, reduction.basis.modes, components)
      .write(group, "sources");
  group.write("gappy_operator", row_major(reduction.gappy_operator.matrix));
  group.write("residual_singular_values", reduction.residual_basis.singular_values);
  group.attribute("residual_rank", static_cast<long long>(reduction.residual_basis.truncation.rank));
  group.attribute("residual_energy", reduction.residual_basis.truncation.energy);
  group.attribute("sigma_min", reduction.gappy_operator.smallest_singular_value);
  group.attribute("condition", reduction.gappy_operator.condition);
  hdf5::Group model = group.create_group("model");
  reduction.sample.save_sample(model);
}

}  // namespace

void write_reduction(const std::filesystem::path& file, const Reduction& reduction) {
  const Teuchos::RCP<const Communicator> communicator = reduction.model.rows()->getComm();
  const int components = static_cast<int>(reduction.model.fields().size());
  const MatrixView reference(reduction.reference.data(), reduction.reference.extent(0), 1);
  AtomicPath path(file, communicator);
  {
    hdf5::File root = hdf5::File::create(path.temporary(), communicator);
    reduction_identity::write(root, reduction.input, reduction.model.parameters());
    root.attribute("provenance", provenance(*communicator).dump());
    root.attribute("components", static_cast<long long>(components));
    root.attribute("particles", static_cast<long long>(reduction.model.rows()->getGlobalNumElements()));
    hdf5::Group window = root.create_group("windows").create_group("0");
    write_basis(window.create_group("basis"), reduction, reference, components);
    write_sample_mesh(window.create_group("sample_mesh"), reduction, reference, components);
    hdf5::Group queries = window.create_group("queries");
    ParticleTable::gather(reduction.queries, *reduction.model.rows(), reduction.model.positions(), reference,
                          reduction.basis.modes, components)
        .write(queries, "particles");
    root.flush();
  }
  path.commit();
}

}  // namespace kiln
