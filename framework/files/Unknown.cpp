#include "framework/files/Unknown.hpp"

#include <Tpetra_Map.hpp>
#include <cmath>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

/// On one rank nothing tells a replicated map from a distributed one, and nothing needs to.
bool replicated(const Map& map) { return !map.isDistributed() && map.getComm()->getSize() > 1; }

void require_finite(const hdf5::Group& group, const std::string& name, ConstVectorView x) {
  const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
  std::optional<Fault> fault;
  for (std::size_t i = 0; i < values.extent(0) && !fault; ++i) {
    if (std::isfinite(values(i))) continue;
    fault = Fault{group.path() + (group.path() == "/" ? "" : "/") + name, "holds " + std::to_string(values(i)),
                  "finite numbers"};
  }
  throw_together(group.communicator(), group.file(), fault);
}

}  // namespace

void save_unknown(hdf5::Group& group, const std::string& name, const Map& map, ConstVectorView x) {
  if (!replicated(map)) {
    group.write_rows(name, map, ConstMatrixView(x.data(), x.extent(0), 1));
    return;
  }
  const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
  hdf5::Array<double> array;
  array.shape = {values.extent(0), 1};
  array.values.assign(values.data(), values.data() + values.extent(0));
  group.write(name, array);
}

void restore_unknown(const hdf5::Group& group, const std::string& name, const Map& map, VectorView x) {
  const auto length = static_cast<std::size_t>(map.getGlobalNumElements());
  if (replicated(map)) {
    const hdf5::Array<double> array = group.reals(name, {length, 1});
    const auto values = Kokkos::create_mirror_view(x);
    for (std::size_t i = 0; i < length; ++i) values(i) = array.values[i];
    Kokkos::deep_copy(x, values);
    require_finite(group, name, x);
    return;
  }
  const std::vector<std::size_t> shape = group.shape(name);
  if (shape != std::vector<std::size_t>{length, 1}) {
    throw FileError(group.file(), group.path() + "/" + name,
                    "the unknown has " + std::to_string(shape.empty() ? 0 : shape[0]) + " entries",
                    std::to_string(length));
  }
  Kokkos::deep_copy(x, Kokkos::subview(group.read_rows(name, map), Kokkos::ALL, 0));
  require_finite(group, name, x);
}

}  // namespace kiln
