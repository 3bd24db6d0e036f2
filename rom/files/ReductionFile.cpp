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
  components_ = static_cast<int>(file_.integer("components"));
  particles_ = file_.integer("particles");
  windows_ = read_windows();
}

std::vector<TimeWindow> ReductionFile::read_windows() const {
  const hdf5::Group group = file_.group("windows");
  const std::size_t count = group.names().size();
  if (count == 0) throw FileError(group.file(), group.path(), "holds no time window", "at least one, named 0");
  std::vector<TimeWindow> windows;
  double end = 0.0;
  int first = 0;
  for (std::size_t w = 0; w < count; ++w) {
    const hdf5::Group one = window(w);
    const TimeWindow read{one.real("end"), first, static_cast<int>(one.group("basis").integer("rank"))};
    if (!(read.end > end)) {
      throw FileError(one.file(), one.path() + ", attribute end", fmt::format("{} s", read.end),
                      fmt::format("a time after {} s, where the window begins", end));
    }
    if (read.size < 1) {
      throw FileError(one.file(), one.path() + "/basis, attribute rank", std::to_string(read.size), "at least 1");
    }
    end = read.end;
    first += read.size;
    windows.push_back(read);
  }
  return windows;
}

hdf5::Group ReductionFile::window(std::size_t number) const {
  return file_.group("windows").group(std::to_string(number));
}

void ReductionFile::require_time(const Teuchos::ParameterList& input) const {
  reduction_identity::require_time(file_, input.sublist("time"));
}

ReductionFile::Rows ReductionFile::basis(const Map& particles) const {
  const MatrixView reference = unfold(file_.read_rows("reference", particles), components_);
  if (reference.extent(1) != 1) {
    throw FileError(file_.file(), "/reference", fmt::format("has {} columns", reference.extent(1)), "one");
  }
  const MatrixView modes("kiln::rom::modes", reference.extent(0), coordinates());
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const hdf5::Group group = window(w).group("basis");
    const MatrixView own = unfold(group.read_rows("modes", particles), components_);
    if (static_cast<int>(own.extent(1)) != windows_[w].size) {
      throw FileError(group.file(), group.path() + "/modes", fmt::format("has {} columns", own.extent(1)),
                      fmt::format("{}, its rank", windows_[w].size));
    }
    const auto columns = std::make_pair(windows_[w].first, windows_[w].first + windows_[w].size);
    Kokkos::deep_copy(Kokkos::subview(modes, Kokkos::ALL, columns), own);
  }
  return {VectorView(Kokkos::subview(reference, Kokkos::ALL, 0)), modes};
}

SampleMesh ReductionFile::sample_mesh(std::size_t number) const {
  const hdf5::Group group = window(number).group("sample_mesh");
  const auto ascending_ids = [&group](const char* name) {
    const hdf5::Array<long long> ids = group.integers(name, {0});
    if (std::adjacent_find(ids.values.begin(), ids.values.end(), std::greater_equal<long long>()) != ids.values.end()) {
      throw FileError(group.file(), group.path() + "/" + name, "particle ids are not in ascending order");
    }
    return std::vector<GlobalIndex>(ids.values.begin(), ids.values.end());
  };
  SampleMesh mesh;
  mesh.rows = ascending_ids("rows");
  mesh.sources = ascending_ids("sources");
  mesh.gappy_operator = group.reals(
      "gappy_operator", {static_cast<std::size_t>(group.integer("residual_rank")), mesh.rows.size() * components_});
  mesh.sigma_min = group.real("sigma_min");
  mesh.condition = group.real("condition");
  return mesh;
}

hdf5::Group ReductionFile::sample_model(std::size_t number) const {
  return window(number).group("sample_mesh").group("model");
}

bool ReductionFile::clustered() const {
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    if (!window(w).has("clusters")) return false;
  }
  return true;
}

hdf5::Group ReductionFile::clusters(std::size_t number) const { return window(number).group("clusters"); }

ParticleTable ReductionFile::held_particles() const {
  return ParticleTable::read(file_.group("particles"), components_, coordinates());
}

ParticleTable ReductionFile::target_particles() const {
  return ParticleTable::read(file_.group("targets"), components_, coordinates());
}

std::vector<GlobalIndex> ReductionFile::queries() const {
  const hdf5::Array<long long> ids = file_.group("particles").integers("queries", {0});
  return {ids.values.begin(), ids.values.end()};
}

ReductionFile::Rows rows_at(const Map& particles, const std::vector<const ParticleTable*>& tables, std::size_t columns,
                            const std::string& file) {
  const std::size_t components = tables.front()->components;
  const std::size_t count = particles.getMyGlobalIndices().extent(0);
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
