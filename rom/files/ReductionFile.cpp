#include "rom/files/ReductionFile.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "framework/base/Error.hpp"
#include "framework/files/Folders.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"
#include "framework/time/TimeLoop.hpp"
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

/// Rows of a dataset with finite values. Collective.
MatrixView finite_rows(const hdf5::Group& group, const std::string& name, const Map& particles, std::size_t rows,
                       std::size_t columns) {
  const std::string place = group.path() == "/" ? "/" + name : group.path() + "/" + name;
  const std::vector<std::size_t> shape = group.shape(name);
  if (shape.size() == 2 && shape[1] != columns) {
    throw FileError(group.file(), place, fmt::format("has {} columns", shape[1]), fmt::format("{}, its rank", columns));
  }
  if (shape != std::vector<std::size_t>{rows, columns}) {
    throw FileError(group.file(), place, fmt::format("has shape {}", fmt::join(shape, " × ")),
                    fmt::format("{} × {}", rows, columns));
  }
  const MatrixView values = group.read_rows(name, particles);
  std::optional<Fault> fault;
  for (std::size_t k = 0; k < values.extent(1) && !fault; ++k) {
    for (std::size_t i = 0; i < values.extent(0) && !fault; ++i) {
      if (!std::isfinite(values(i, k))) fault = Fault{place, fmt::format("holds {}", values(i, k)), "finite numbers"};
    }
  }
  throw_together(group.communicator(), group.file(), fault);
  return values;
}

}  // namespace

std::filesystem::path ReductionFile::path(const Teuchos::ParameterList& input) {
  const Teuchos::ParameterList& method = input.sublist("method");
  if (method.isParameter("file")) return method.get<std::string>("file");
  return reduction_file(input);
}

ReductionFile::ReductionFile(const Teuchos::ParameterList& input, const Teuchos::RCP<const Communicator>& communicator)
    : file_(open(path(input), communicator)) {
  reduction_identity::require_format(file_);
  file_.require_seal();
  reduction_identity::require_model(file_, input.sublist("model"));
  components_ = static_cast<int>(file_.integer("components", 1, 1000));
  particles_ = file_.integer("particles", 1, std::numeric_limits<LocalIndex>::max());
  windows_ = read_windows();
}

std::vector<TimeWindow> ReductionFile::read_windows() const {
  const hdf5::Group group = file_.group("windows");
  const std::size_t count = group.names().size();
  if (count == 0) throw FileError(group.file(), group.path(), "holds no time window", "at least one, named 0");
  std::vector<TimeWindow> windows;
  double end = 0.0;
  int first = 0;
  const long long most = std::numeric_limits<int>::max() / 2;
  for (std::size_t w = 0; w < count; ++w) {
    const hdf5::Group one = window(w);
    const TimeWindow read{one.finite_real("end"), first,
                          static_cast<int>(one.group("basis").integer("rank", 1, most - first))};
    if (!(read.end > end)) {
      throw FileError(one.file(), one.path() + ", attribute end", fmt::format("{} s", read.end),
                      fmt::format("a time after {} s, where the window begins", end));
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

void ReductionFile::require_components(std::size_t components) const {
  if (components == static_cast<std::size_t>(components_)) return;
  throw FileError(file_.file(), "attribute components", std::to_string(components_),
                  fmt::format("{}, as the model has", components));
}

void ReductionFile::require_size(const Map& rows, std::size_t components) const {
  require_components(components);
  const auto particles = static_cast<long long>(rows.getGlobalNumElements());
  if (particles == particles_) return;
  throw FileError(file_.file(), "attribute particles", std::to_string(particles_),
                  fmt::format("{}, as the model has", particles));
}

void ReductionFile::require_end(const Teuchos::ParameterList& input) const {
  const TimeSpan span = TimeSpan::of(input);
  const double end = span.step * span.last_step, trained = windows_.back().end;
  // Sums of steps round otherwise than their product.
  if (end <= trained + 0.5 * span.step) return;
  throw FileError(file_.file(), "",
                  fmt::format("was trained to {:.6g} s, and this run goes on to {:.6g} s", trained, end),
                  "a run that ends there, or earlier; or train again, to a later end");
}

void ReductionFile::require_time(const Teuchos::ParameterList& input) const {
  reduction_identity::require_time(file_, input.sublist("time"));
}

BasisRows ReductionFile::basis(const Map& particles) const {
  const std::size_t components = components_;
  const MatrixView reference = unfold(finite_rows(file_, "reference", particles, particles_, components), components_);
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const hdf5::Group group = window(w).group("basis");
    const std::vector<std::size_t> shape = group.shape("modes");
    const std::size_t columns = windows_[w].size * components;
    // Before room is made for as many as are declared.
    if (shape.size() != 2 || shape[1] != columns) {
      throw FileError(group.file(), group.path() + "/modes",
                      fmt::format("has {} columns", shape.empty() ? 0 : shape.back()),
                      fmt::format("{}, its rank", columns));
    }
  }
  const MatrixView modes("kiln::rom::modes", reference.extent(0), coordinates());
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const hdf5::Group group = window(w).group("basis");
    const MatrixView own =
        unfold(finite_rows(group, "modes", particles, particles_, windows_[w].size * components), components_);
    const auto columns = std::make_pair(windows_[w].first, windows_[w].first + windows_[w].size);
    Kokkos::deep_copy(Kokkos::subview(modes, Kokkos::ALL, columns), own);
  }
  return {VectorView(Kokkos::subview(reference, Kokkos::ALL, 0)), modes};
}

SampleMesh ReductionFile::sample_mesh(std::size_t number) const {
  const hdf5::Group group = window(number).group("sample_mesh");
  SampleMesh mesh;
  mesh.rows = ids(group, "rows");
  mesh.sources = ids(group, "sources");
  const std::size_t width = mesh.rows.size() * components_;
  const long long rank = group.integer("residual_rank", 1, static_cast<long long>(width));
  mesh.gappy_operator = group.finite_reals("gappy_operator", {static_cast<std::size_t>(rank), width});
  mesh.sigma_min = group.real("sigma_min");
  mesh.condition = group.real("condition");
  return mesh;
}

std::vector<GlobalIndex> ReductionFile::ids(const hdf5::Group& group, const std::string& name) const {
  return ids(group, name, 0, particles_ - 1);
}

std::vector<GlobalIndex> ReductionFile::ids(const hdf5::Group& group, const std::string& name, GlobalIndex first,
                                            GlobalIndex last) const {
  const std::vector<long long> found = group.integers(name, {0}).values;
  const auto refuse = [&](std::string problem, std::string expected) {
    throw FileError(group.file(), group.path() + "/" + name, std::move(problem), std::move(expected));
  };
  if (found.empty()) refuse("holds no particle", "at least one");
  if (std::adjacent_find(found.begin(), found.end(), std::greater_equal<long long>()) != found.end()) {
    refuse("particle ids are not in ascending order", "");
  }
  if (found.front() < first || found.back() > last) {
    refuse(fmt::format("holds particle {}", found.front() < first ? found.front() : found.back()),
           fmt::format("{} to {}", first, last));
  }
  return {found.begin(), found.end()};
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

ParticleTable ReductionFile::cluster_table(std::size_t number) const {
  const hdf5::Group group = clusters(number);
  // More of them than this would not be few.
  const GlobalIndex last = std::numeric_limits<LocalIndex>::max();
  return ParticleTable::read(group, ids(group, "ids", particles_, last), components_,
                             windows_[number].first + windows_[number].size);
}

ParticleTable ReductionFile::held_particles() const {
  const hdf5::Group group = file_.group("particles");
  return ParticleTable::read(group, ids(group, "ids"), components_, coordinates());
}

ParticleTable ReductionFile::target_particles() const {
  const hdf5::Group group = file_.group("targets");
  return ParticleTable::read(group, ids(group, "ids"), components_, coordinates());
}

Questions ReductionFile::questions() const { return Questions::read(file_.group("particles")); }

std::vector<TrainedRange> ReductionFile::trained_ranges() const { return read_trained_ranges(file_); }

nlohmann::json ReductionFile::trial(bool clustered) const {
  const std::string name = clustered ? "trial_clustered" : "trial";
  if (!file_.has_attribute(name)) return {};
  nlohmann::json trial = parse_json(file_.text(name));
  if (trial.is_object()) return trial;
  throw FileError(file_.file(), "attribute " + name, "is no JSON object", "the errors of a trial run");
}

}  // namespace kiln
