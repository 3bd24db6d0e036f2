#include "framework/files/RunFile.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "framework/base/Error.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Reserve.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

constexpr double not_written = std::numeric_limits<double>::quiet_NaN();

/// Bytes of a whole file: datasets, and what HDF5 notes of each frame's view.
std::uint64_t room_for(std::size_t particles, const RunFile::Contents& contents) {
  const std::uint64_t frames = contents.steps.size(), fields = contents.fields.size(), number = sizeof(double);
  return number * (particles * (7 + fields * (frames + 1)) + frames * (2 + contents.coordinates)) +
         1024 * frames * fields + 65536;
}

/// A vector of particles × components as a matrix.
MatrixView matrix_of(ConstVectorView u, LocalIndex particles, int components) {
  MatrixView matrix("kiln::files::frame", static_cast<std::size_t>(particles), static_cast<std::size_t>(components));
  Kokkos::parallel_for(
      "kiln::files::components", RangePolicy(0, particles), KOKKOS_LAMBDA(const LocalIndex i) {
        for (int c = 0; c < components; ++c) matrix(i, c) = u(i * components + c);
      });
  return matrix;
}

MatrixView matrix_of(ConstPositionView positions) {
  MatrixView matrix("kiln::files::positions", positions.extent(0), 3);
  Kokkos::parallel_for(
      "kiln::files::positions", RangePolicy(0, static_cast<LocalIndex>(positions.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) {
        for (int d = 0; d < 3; ++d) matrix(i, d) = positions(i, d);
      });
  return matrix;
}

}  // namespace

RunFile::RunFile(std::filesystem::path folder, const Map& particles, ConstPositionView positions, Contents contents,
                 int first_step, Teuchos::RCP<const Communicator> communicator)
    : folder_(std::move(folder)),
      communicator_(std::move(communicator)),
      contents_(std::move(contents)),
      order_(particles),
      file_(first_step > 0 ? reopened(first_step) : created(positions)),
      times_(file_.opened("time")),
      steps_(file_.opened("step")) {
  const hdf5::Group newest = file_.group("VTKHDF/PointData");
  for (const Field& field : contents_.fields) {
    fields_.push_back(file_.opened(field.name));
    newest_.push_back(newest.opened(field.name));
  }
  if (contents_.coordinates > 0) coordinates_ = file_.opened("coordinates");
  write_xdmf();
}

hdf5::File RunFile::created(ConstPositionView positions) const {
  AtomicPath place(path(), communicator_);
  hdf5::File file = hdf5::create_with_room(place.temporary(), room_for(order_.rows(), contents_), communicator_);
  fill(file, positions);
  file.flush();
  place.commit_unsynchronised();
  file.was_renamed(path());
  return file;
}

void RunFile::fill(hdf5::File& file, ConstPositionView positions) const {
  const std::size_t particles = order_.rows();
  const std::size_t frames = contents_.steps.size();
  for (const auto& [name, value] : contents_.provenance) file.attribute(name, value);
  file.create_integers("particle", {particles}, -1);
  file.write_block("particle", {order_.first()}, {order_.count()}, order_.ids());
  file.create_reals("position", {particles, 3}, not_written);
  file.write_block("position", {order_.first(), 0}, {order_.count(), 3}, order_.slab(matrix_of(positions)));
  file.attribute_of("position", "unit", "m");
  file.create_reals("time", {frames}, not_written);
  file.attribute_of("time", "unit", "s");
  file.create_integers("step", {frames}, -1);
  for (const Field& field : contents_.fields) {
    file.create_reals(field.name, {frames, particles}, not_written);
    file.attribute_of(field.name, "unit", field.unit);
  }
  if (contents_.coordinates > 0) {
    file.create_reals("coordinates", {frames, contents_.coordinates}, not_written);
    file.attribute_of("coordinates", "unit", "1");
  }
  hdf5::Group views = file.create_group("frame");
  for (const Field& field : contents_.fields) views.create_group(field.name).create_row_views("/" + field.name);
  fill_vtkhdf(file);
}

/// VTK's own file format: an unstructured grid with one vertex cell a particle.
void RunFile::fill_vtkhdf(hdf5::File& file) const {
  constexpr unsigned char vertex = 1;  // VTK_VERTEX
  const std::size_t particles = order_.rows();
  hdf5::Group group = file.create_group("VTKHDF");
  group.attribute("Version", std::vector<long long>{1, 0});
  group.ascii_attribute("Type", "UnstructuredGrid");
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
    group.write(name, std::vector<long long>{static_cast<long long>(particles)});
  }
  group.link("Points", "/position");
  std::vector<long long> numbers(order_.count());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<long long>(order_.first() + i);
  group.create_integers("Connectivity", {particles}, 0);
  group.write_block("Connectivity", {order_.first()}, {order_.count()}, numbers);
  // The fill value is the last entry: one past the last vertex.
  group.create_integers("Offsets", {particles + 1}, static_cast<long long>(particles));
  group.write_block("Offsets", {order_.first()}, {order_.count()}, numbers);
  group.create_bytes("Types", {particles}, vertex);
  hdf5::Group data = group.create_group("PointData");
  data.link("particle", "/particle");
  for (const Field& field : contents_.fields) data.create_reals(field.name, {particles}, not_written);
}

hdf5::File RunFile::reopened(int first_step) {
  hdf5::File file = hdf5::File::modify(path(), communicator_);
  const std::size_t particles = order_.rows();
  const std::size_t frames = contents_.steps.size();
  const std::vector<long long> ids = file.integers("particle", {particles}).values;
  const bool same =
      std::equal(order_.ids().begin(), order_.ids().end(), ids.begin() + static_cast<std::ptrdiff_t>(order_.first()));
  throw_together(*communicator_, path(),
                 same ? std::nullopt
                      : std::optional<Fault>(Fault{"/particle", "holds other particles than this run",
                                                   "the file that the interrupted run left"}));
  for (const Field& field : contents_.fields) {
    const std::vector<std::size_t> shape = file.shape(field.name);
    if (shape != std::vector<std::size_t>{frames, particles}) {
      throw FileError(path(), "/" + field.name, fmt::format("has shape {}", fmt::join(shape, " × ")),
                      fmt::format("{} frames × {} particles; continue with the end time and the output interval of the "
                                  "interrupted run, or in another folder",
                                  frames, particles));
    }
  }
  std::vector<double> times = file.reals("time", {frames}).values;
  std::vector<long long> steps = file.integers("step", {frames}).values;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const bool known = steps[frame] == -1 || steps[frame] == contents_.steps[frame];
    if (!known) {
      throw FileError(
          path(), "/step", fmt::format("frame {} is of step {}", frame, steps[frame]),
          fmt::format("step {}; continue with the output interval of the interrupted run", contents_.steps[frame]));
    }
    if (contents_.steps[frame] > first_step) {
      times[frame] = not_written;
      steps[frame] = -1;
    } else if (!std::isnan(times[frame])) {
      written_.push_back({frame, times[frame]});
    }
  }
  xdmf_interval_ = ExchangeInterval(static_cast<int>(written_.size()));
  const std::size_t count = root_count() * frames;
  times.resize(count);
  steps.resize(count);
  file.write_block("time", {0}, {count}, times);
  file.write_block("step", {0}, {count}, steps);
  file.flush();
  return file;
}

void RunFile::write(int step, double time, ConstVectorView u, ConstVectorView x) {
  const auto found = std::lower_bound(contents_.steps.begin(), contents_.steps.end(), step);
  if (found == contents_.steps.end() || *found != step) {
    throw std::logic_error(fmt::format("{}: step {} is none of the frames planned", path(), step));
  }
  const auto frame = static_cast<std::size_t>(found - contents_.steps.begin());
  const std::size_t components = contents_.fields.size();
  const auto particles = static_cast<LocalIndex>(u.extent(0) / components);
  const std::vector<double> slab = order_.slab(matrix_of(u, particles, static_cast<int>(components)));
  std::vector<double> values(order_.count());
  for (std::size_t c = 0; c < components; ++c) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = slab[i * components + c];
    fields_[c].write_block({frame, order_.first()}, {1, order_.count()}, values);
    newest_[c].write_block({order_.first()}, {order_.count()}, values);
  }
  const std::size_t count = root_count();
  if (coordinates_) {
    const auto coordinates = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
    const std::vector<double> row(coordinates.data(), coordinates.data() + count * contents_.coordinates);
    coordinates_->write_block({frame, 0}, {count, count * contents_.coordinates}, row);
  }
  // The time comes last: it says that the frame is whole.
  steps_.write_block({frame}, {count}, std::vector<long long>(count, step));
  times_.write_block({frame}, {count}, std::vector<double>(count, time));
  written_.push_back({frame, time});
  if (xdmf_is_due()) write_xdmf();
}

bool RunFile::xdmf_is_due() {
  const auto number = static_cast<int>(written_.size());
  // Until the second frame nothing tells the frames' pace.
  if (number == 1) xdmf_interval_ = ExchangeInterval(1);
  if (!xdmf_interval_.due(number)) return false;
  // Its length grows with the frames: writing it after each of very many would take longer than the frames.
  const int mine = std::max(xdmf_interval_.steps_to_come(number), 1 + number / 16);
  int least = mine;
  Teuchos::reduceAll(*communicator_, Teuchos::REDUCE_MIN, 1, &mine, &least);
  xdmf_interval_.exchanged(number, least);
  return number > 2 || least == 1;
}

void RunFile::write_xdmf() {
  if (listed_ == written_.size()) return;
  write_atomically(folder_ / "run.xdmf", xdmf("run.h5", order_.rows(), contents_.fields, written_), communicator_,
                   false);
  listed_ = written_.size();
}

}  // namespace kiln
