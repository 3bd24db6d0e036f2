#include "rom/files/ReductionFile.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"
#include "rom/files/ReductionIdentity.hpp"

namespace kiln {
namespace {

hdf5::File open(const std::filesystem::path& path, const Teuchos::RCP<const Communicator>& communicator) {
  on_root(*communicator, path.string(), [&path]() -> std::optional<Fault> {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return std::nullopt;
    return Fault{"", "there is no such file", "a reduction; `kiln train` writes it"};
  });
  return hdf5::File::read(path.string(), communicator);
}

}  // namespace

std::filesystem::path ReductionFile::path(const Teuchos::ParameterList& input) {
  const Teuchos::ParameterList& method = input.sublist("method");
  if (method.isParameter("file")) return method.get<std::string>("file");
  return std::filesystem::path(input.sublist("output").get<std::string>("directory")) / "reduction.h5";
}

ReductionFile::ReductionFile(const Teuchos::ParameterList& input, const Teuchos::RCP<const Communicator>& communicator)
    : file_(open(path(input), communicator)) {
  reduction_identity::require_format(file_);
  reduction_identity::require_model(file_, input.sublist("model"));
  const std::vector<std::string> windows = file_.group("windows").names();
  if (windows.size() != 1 || windows.front() != "0") {
    throw FileError(file_.file(), "windows", fmt::format("holds {} time windows", windows.size()),
                    "one window, named 0");
  }
  components_ = static_cast<int>(file_.integer("components"));
  particles_ = file_.integer("particles");
  basis_rank_ = static_cast<int>(window().group("basis").integer("rank"));
}

hdf5::Group ReductionFile::window() const { return file_.group("windows").group("0"); }

void ReductionFile::require_time(const Teuchos::ParameterList& input) const {
  reduction_identity::require_time(file_, input.sublist("time"));
}

int ReductionFile::residual_rank() const {
  return static_cast<int>(window().group("sample_mesh").integer("residual_rank"));
}

std::unique_ptr<AffineBasis> ReductionFile::basis(const Map& particles) const {
  const hdf5::Group group = window().group("basis");
  const MatrixView reference = unfold(group.read_rows("reference", particles), components_);
  const MatrixView modes = unfold(group.read_rows("modes", particles), components_);
  if (static_cast<int>(modes.extent(1)) != basis_rank_ || reference.extent(1) != 1) {
    throw FileError(group.file(), group.path() + "/modes",
                    fmt::format("has {} columns, reference has {}", modes.extent(1), reference.extent(1)),
                    fmt::format("{} and 1", basis_rank_));
  }
  return std::make_unique<AffineBasis>(VectorView(Kokkos::subview(reference, Kokkos::ALL, 0)), modes);
}

SampleMesh ReductionFile::sample_mesh() const {
  const hdf5::Group group = window().group("sample_mesh");
  SampleMesh mesh;
  const hdf5::Array<long long> rows = group.integers("rows", {0});
  mesh.rows.assign(rows.values.begin(), rows.values.end());
  mesh.sources = ParticleTable::read(group, "sources", components_, basis_rank_);
  mesh.queries = ParticleTable::read(window().group("queries"), "particles", components_, basis_rank_);
  mesh.gappy_operator =
      group.reals("gappy_operator", {static_cast<std::size_t>(residual_rank()), mesh.rows.size() * components_});
  mesh.sigma_min = group.real("sigma_min");
  mesh.condition = group.real("condition");
  return mesh;
}

hdf5::Group ReductionFile::sample_model() const { return window().group("sample_mesh").group("model"); }

std::unique_ptr<AffineBasis> basis_at(const Map& particles, const std::vector<const ParticleTable*>& tables,
                                      const std::string& file) {
  const ParticleTable& first = *tables.front();
  const std::size_t components = first.components, modes = first.modes.shape[1] / components;
  const std::size_t count = particles.getMyGlobalIndices().extent(0);
  VectorView reference("kiln::rom::reference", count * components);
  MatrixView values("kiln::rom::modes", count * components, modes);
  std::optional<Fault> fault;
  for (std::size_t i = 0; i < count; ++i) {
    const GlobalIndex id = particles.getGlobalElement(static_cast<LocalIndex>(i));
    const auto table = std::find_if(tables.begin(), tables.end(), [id](const auto* t) { return t->find(id) >= 0; });
    if (table == tables.end()) {
      fault = Fault{"", fmt::format("holds no basis row of particle {}", id), {}};
      break;
    }
    const std::size_t row = (*table)->find(id);
    for (std::size_t c = 0; c < components; ++c) {
      reference(i * components + c) = (*table)->reference.values[row * components + c];
      for (std::size_t k = 0; k < modes; ++k) {
        values(i * components + c, k) = (*table)->modes.values[(row * modes + k) * components + c];
      }
    }
  }
  throw_together(*particles.getComm(), file, fault);
  return std::make_unique<AffineBasis>(reference, values);
}

}  // namespace kiln
