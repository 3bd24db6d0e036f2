#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Hdf5Node.hpp"

namespace kiln::hdf5 {
namespace {

std::size_t product(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

Id data_space(const std::vector<std::size_t>& shape) {
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  return Id(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
      H5Sclose);
}

/// This rank's part of a dataset in the file and in memory.
struct Selection {
  Id file;
  Id memory;
};

Selection select(const Dataset& dataset, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count) {
  Selection selection{Id(H5Dget_space(dataset.id), H5Sclose), data_space(count)};
  if (product(count) == 0) {
    H5Sselect_none(selection.file);
    H5Sselect_none(selection.memory);
  } else if (!count.empty()) {
    const std::vector<hsize_t> first(start.begin(), start.end());
    const std::vector<hsize_t> extent(count.begin(), count.end());
    const herr_t selected =
        H5Sselect_hyperslab(selection.file, H5S_SELECT_SET, first.data(), nullptr, extent.data(), nullptr);
    // Reading and writing then fail, and say so.
    if (selected < 0) selection.file = Id(H5I_INVALID_HID, H5Sclose);
  }
  return selection;
}

/// Ranks agree on how a large dataset is moved, piece by piece; for a small one that takes longer than moving it, and
/// so do properties of its own.
Id transfer_properties(const Node& node, const Dataset& dataset) {
  constexpr std::size_t large = 1 << 20;
  if (!node.file->parallel || product(dataset.shape) * sizeof(double) < large) {
    return Id(H5P_DEFAULT, [](hid_t) { return herr_t(0); });
  }
  Id properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(properties, H5FD_MPIO_COLLECTIVE);
  return properties;
}

void check_block(const Node& node, const Dataset& dataset, const std::string& name,
                 const std::vector<std::size_t>& start, const std::vector<std::size_t>& count) {
  bool inside = start.size() == dataset.shape.size() && count.size() == dataset.shape.size();
  for (std::size_t d = 0; inside && d < count.size(); ++d) inside = start[d] + count[d] <= dataset.shape[d];
  throw_together(node.communicator(), node.file->path,
                 inside ? std::nullopt
                        : std::optional<Fault>(Fault{node.path_of(name), "has shape " + shape_text(dataset.shape),
                                                     fmt::format("room for the block of {} at {}", shape_text(count),
                                                                 fmt::join(start, ", "))}));
}

template <class T>
void write_replicated(const Node& node, const std::string& name, hid_t type, const Array<T>& array) {
  if (array.values.size() != product(array.shape)) {
    throw std::logic_error(fmt::format("{}: {}: {} values do not make the shape {}", node.file->path,
                                       node.path_of(name), array.values.size(), shape_text(array.shape)));
  }
  create_dataset(node, name, type, array.shape, nullptr, false);
  const Dataset dataset = open_dataset(node, name);
  bool written = true;
  if (node.communicator().getRank() == 0 && !array.values.empty()) {
    written = H5Dwrite(dataset.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) >= 0;
  }
  node.require(written, name, "written");
}

template <class T>
Array<T> read_replicated(const Node& node, const std::string& name, H5T_class_t kind, hid_t type) {
  const Dataset dataset = open_dataset(node, name, kind);
  check_values(node, dataset, name);
  Array<T> array{dataset.shape, std::vector<T>(product(dataset.shape))};
  bool read = true;
  if (node.communicator().getRank() == 0 && !array.values.empty()) {
    read = H5Dread(dataset.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) >= 0;
  }
  node.require(read, name, "read");
  broadcast(node.communicator(), 0, array.values.data(), array.values.size());
  return array;
}

void require_type(const Node& node, const Dataset& dataset, const std::string& name, H5T_class_t type) {
  if (dataset.type == type) return;
  const auto words = [](H5T_class_t kind) -> std::string {
    if (kind == H5T_FLOAT) return "floating-point numbers";
    if (kind == H5T_INTEGER) return "integers";
    return kind == H5T_STRING ? "texts" : "something else";
  };
  node.fail(name, "holds " + words(dataset.type), words(type));
}

/// A shape is a few bytes of a file; the values must be in it, too.
void require_values(const Node& node, const Dataset& dataset, const std::string& name) {
  const Id type(H5Dget_type(dataset.id), H5Tclose);
  const Id properties(H5Dget_create_plist(dataset.id), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (layout == H5D_VIRTUAL) return;
  std::size_t declared = H5Tget_size(type);
  bool overflow = false;
  for (const std::size_t extent : dataset.shape)
    overflow = __builtin_mul_overflow(declared, extent, &declared) || overflow;
  // No compression that makes sense saves more.
  constexpr std::size_t best_compression = 4096;
  const std::size_t stored = H5Dget_storage_size(dataset.id);
  const std::size_t most = layout == H5D_CHUNKED ? std::max<std::size_t>(stored, 1) * best_compression : stored;
  if (!overflow && declared <= most) return;
  node.fail(name, "has shape " + shape_text(dataset.shape),
            fmt::format("values for all of it: there are {} bytes", stored));
}

void check_shape(const Node& node, const std::string& name, const std::vector<std::size_t>& found,
                 const std::vector<std::size_t>& wanted) {
  bool same = found.size() == wanted.size();
  for (std::size_t d = 0; same && d < wanted.size(); ++d) same = wanted[d] == 0 || wanted[d] == found[d];
  if (!same) node.fail(name, "has shape " + shape_text(found), "shape " + shape_text(wanted) + " (0: any)");
}

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
  return shape.empty() ? "of a single value" : fmt::format("{}", fmt::join(shape, " × "));
}

Dataset open_dataset(const Node& node, const std::string& name) {
  if (!(H5Lexists(node.id, name.c_str(), H5P_DEFAULT) > 0)) {
    H5Eclear2(H5E_DEFAULT);
    node.fail(name, "is missing", "a dataset");
  }
  Id id(H5Dopen2(node.id, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!id.valid()) node.fail(name, "is no readable dataset" + reason(), "a dataset");
  const Id type(H5Dget_type(id), H5Tclose);
  const Id space(H5Dget_space(id), H5Sclose);
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return {std::move(id), std::vector<std::size_t>(extent.begin(), extent.end()), H5Tget_class(type)};
}

Dataset open_dataset(const Node& node, const std::string& name, H5T_class_t type) {
  Dataset dataset = open_dataset(node, name);
  require_type(node, dataset, name, type);
  require_values(node, dataset, name);
  return dataset;
}

void check_values(const Node& node, const Dataset& dataset, const std::string& name) {
  if (node.file->fingerprint.empty()) return;
  const hsize_t length = H5Dget_storage_size(dataset.id);
  const haddr_t offset = H5Dget_offset(dataset.id);
  if (length < large_dataset || offset == HADDR_UNDEF) return;
  on_root(node.communicator(), node.file->path, [&]() -> std::optional<Fault> {
    const std::vector<Segment>& seal = node.file->seal;
    for (std::size_t s = 0; s < seal.size(); ++s) {
      if (seal[s].offset != offset || seal[s].length != length || node.file->checked[s]) continue;
      check_segment(node.file->path, seal[s], node.path_of(name));
      node.file->checked[s] = true;
    }
    return std::nullopt;
  });
}

void create_dataset(const Node& node, const std::string& name, hid_t type, const std::vector<std::size_t>& shape,
                    const void* fill, bool early) {
  const Id space = data_space(shape);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_layout(properties, H5D_CONTIGUOUS);
  if (early) H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
  if (fill != nullptr) H5Pset_fill_value(properties, type, fill);
  const Id dataset(H5Dcreate2(node.id, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  node.require(dataset.valid(), name, "created");
}

std::vector<double> read_slab(const Node& node, const Dataset& dataset, const std::string& name,
                              const std::vector<std::size_t>& start, const std::vector<std::size_t>& count) {
  check_block(node, dataset, name, start, count);
  check_values(node, dataset, name);
  const Selection selection = select(dataset, start, count);
  std::vector<double> values(product(count));
  const bool read = H5Dread(dataset.id, H5T_NATIVE_DOUBLE, selection.memory, selection.file,
                            transfer_properties(node, dataset), values.data()) >= 0;
  node.require(read, name, "read");
  return values;
}

void write_slab(const Node& node, const Dataset& dataset, const std::string& name,
                const std::vector<std::size_t>& start, const std::vector<std::size_t>& count, hid_t type,
                const void* values) {
  check_block(node, dataset, name, start, count);
  const Selection selection = select(dataset, start, count);
  const bool written =
      H5Dwrite(dataset.id, type, selection.memory, selection.file, transfer_properties(node, dataset), values) >= 0;
  node.require(written, name, "written");
}

void Group::write(const std::string& name, const Array<double>& array) {
  write_replicated(*node_, name, H5T_NATIVE_DOUBLE, array);
}
void Group::write(const std::string& name, const Array<long long>& array) {
  write_replicated(*node_, name, H5T_NATIVE_LLONG, array);
}
void Group::write(const std::string& name, const std::vector<double>& values) {
  write(name, Array<double>{{values.size()}, values});
}
void Group::write(const std::string& name, const std::vector<long long>& values) {
  write(name, Array<long long>{{values.size()}, values});
}

Array<double> Group::reals(const std::string& name) const {
  return read_replicated<double>(*node_, name, H5T_FLOAT, H5T_NATIVE_DOUBLE);
}
Array<long long> Group::integers(const std::string& name) const {
  return read_replicated<long long>(*node_, name, H5T_INTEGER, H5T_NATIVE_LLONG);
}

Array<double> Group::reals(const std::string& name, const std::vector<std::size_t>& shape) const {
  check_shape(*node_, name, open_dataset(*node_, name, H5T_FLOAT).shape, shape);
  return reals(name);
}
Array<long long> Group::integers(const std::string& name, const std::vector<std::size_t>& shape) const {
  check_shape(*node_, name, open_dataset(*node_, name, H5T_INTEGER).shape, shape);
  return integers(name);
}

Array<double> Group::finite_reals(const std::string& name, const std::vector<std::size_t>& shape) const {
  Array<double> array = reals(name, shape);
  const auto bad = std::find_if(array.values.begin(), array.values.end(), [](double x) { return !std::isfinite(x); });
  if (bad != array.values.end()) {
    node_->fail(name, fmt::format("value {} is {}", bad - array.values.begin(), *bad), "finite numbers");
  }
  return array;
}

std::vector<std::size_t> Group::shape(const std::string& name) const { return open_dataset(*node_, name).shape; }

bool Group::holds_reals(const std::string& name) const {
  if (!has(name)) return false;
  const Id object(H5Oopen(node_->id, name.c_str(), H5P_DEFAULT), H5Oclose);
  return H5Iget_type(object) == H5I_DATASET && open_dataset(*node_, name).type == H5T_FLOAT;
}

bool Group::holds_integers(const std::string& name) const {
  if (!has(name)) return false;
  const Id object(H5Oopen(node_->id, name.c_str(), H5P_DEFAULT), H5Oclose);
  return H5Iget_type(object) == H5I_DATASET && open_dataset(*node_, name).type == H5T_INTEGER;
}

void Group::create_reals(const std::string& name, const std::vector<std::size_t>& shape, double fill) {
  create_dataset(*node_, name, H5T_NATIVE_DOUBLE, shape, &fill, true);
}
void Group::create_integers(const std::string& name, const std::vector<std::size_t>& shape, long long fill) {
  create_dataset(*node_, name, H5T_NATIVE_LLONG, shape, &fill, true);
}

void Group::create_bytes(const std::string& name, const std::vector<std::size_t>& shape, unsigned char fill) {
  create_dataset(*node_, name, H5T_NATIVE_UCHAR, shape, &fill, true);
}

void Group::create_row_views(const std::string& dataset) {
  const std::vector<std::size_t> shape = open_dataset(*node_, dataset, H5T_FLOAT).shape;
  if (shape.size() != 2) node_->fail(dataset, "has shape " + shape_text(shape), "two dimensions");
  const Id source = data_space(shape);
  const Id view = data_space({shape[1]});
  bool created = true;
  for (std::size_t row = 0; row < shape[0]; ++row) {
    const hsize_t start[2] = {row, 0};
    const hsize_t count[2] = {1, shape[1]};
    H5Sselect_hyperslab(source, H5S_SELECT_SET, start, nullptr, count, nullptr);
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_virtual(properties, view, ".", dataset.c_str(), source);
    const Id shown(H5Dcreate2(node_->id, std::to_string(row).c_str(), H5T_NATIVE_DOUBLE, view, H5P_DEFAULT, properties,
                              H5P_DEFAULT),
                   H5Dclose);
    created = created && shown.valid();
  }
  node_->require(created, "", "filled with views of " + dataset);
}

void Group::link(const std::string& name, const std::string& target) {
  const herr_t linked =
      H5Lcreate_hard(node_->file->id, target.c_str(), node_->id, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  node_->require(linked >= 0, name, "linked to " + target);
}

OpenedDataset::OpenedDataset(std::shared_ptr<Node> node, std::string name)
    : node_(std::move(node)), name_(std::move(name)), dataset_(std::make_shared<Dataset>(open_dataset(*node_, name_))) {
  require_values(*node_, *dataset_, name_);
}

void OpenedDataset::write_block(const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                                const std::vector<double>& values) {
  require_type(*node_, *dataset_, name_, H5T_FLOAT);
  write_slab(*node_, *dataset_, name_, start, count, H5T_NATIVE_DOUBLE, values.data());
}
void OpenedDataset::write_block(const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                                const std::vector<long long>& values) {
  require_type(*node_, *dataset_, name_, H5T_INTEGER);
  write_slab(*node_, *dataset_, name_, start, count, H5T_NATIVE_LLONG, values.data());
}

OpenedDataset Group::opened(const std::string& name) const { return {node_, name}; }

void Group::write_block(const std::string& name, const std::vector<std::size_t>& start,
                        const std::vector<std::size_t>& count, const std::vector<double>& values) {
  opened(name).write_block(start, count, values);
}
void Group::write_block(const std::string& name, const std::vector<std::size_t>& start,
                        const std::vector<std::size_t>& count, const std::vector<long long>& values) {
  opened(name).write_block(start, count, values);
}
std::vector<double> Group::read_block(const std::string& name, const std::vector<std::size_t>& start,
                                      const std::vector<std::size_t>& count) const {
  return read_slab(*node_, open_dataset(*node_, name, H5T_FLOAT), name, start, count);
}

}  // namespace kiln::hdf5
