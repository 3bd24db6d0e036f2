#include "unit_tests/fuzz/Edits.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstring>

#include "framework/files/Hdf5Node.hpp"
#include "framework/files/Seal.hpp"
#include "unit_tests/fuzz/Harness.hpp"

namespace kiln::fuzz {
namespace {

using hdf5::Id;

constexpr std::size_t bytes_an_edit = 12;

herr_t note_attribute(hid_t, const char* name, const H5A_info_t*, void* data) {
  auto& parts = *static_cast<std::vector<Part>*>(data);
  parts.push_back({parts.back().object, name});
  return 0;
}

herr_t note_object(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  auto& parts = *static_cast<std::vector<Part>*>(data);
  parts.push_back({name, ""});
  const bool is_dataset = info->type == H5O_TYPE_DATASET;
  const std::size_t at = parts.size() - 1;
  const Id object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_attribute, data);
  if (!is_dataset) parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at));
  return 0;
}

struct Change {
  unsigned kind;
  std::uint64_t bits;
  double number() const {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
};

void edit_attribute(hid_t file, const Part& part, const Change& change) {
  const Id object(H5Oopen(file, part.object.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object.valid() || H5Aexists(object, part.attribute.c_str()) <= 0) return;
  const auto* number = reinterpret_cast<const std::int64_t*>(&change.bits);
  H5Adelete(object, part.attribute.c_str());
  const hsize_t two = 2;
  const Id scalar(H5Screate(H5S_SCALAR), H5Sclose), pair(H5Screate_simple(1, &two, nullptr), H5Sclose);
  const auto put = [&](hid_t type, hid_t space, const void* value) {
    const Id attribute(H5Acreate2(object, part.attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute.valid()) H5Awrite(attribute, type, value);
  };
  const std::int64_t numbers[2] = {*number, *number};
  const double real = change.number();
  char text[9] = {};
  std::memcpy(text, &change.bits, 8);
  const char* start = text;
  const Id variable(H5Tcopy(H5T_C_S1), H5Tclose), fixed(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(variable, H5T_VARIABLE);
  H5Tset_size(fixed, 8);
  switch (change.kind % 7) {
    case 0:
      return;
    case 1:
      return put(H5T_NATIVE_INT64, scalar, number);
    case 2:
      return put(H5T_NATIVE_DOUBLE, scalar, &real);
    case 3:
      return put(variable, scalar, &start);
    case 4:
      return put(fixed, scalar, text);
    case 5:
      return put(H5T_NATIVE_INT64, pair, numbers);
    default:
      return put(H5T_NATIVE_UINT8, scalar, number);
  }
}

void replace(hid_t file, const std::string& name, hid_t type, const std::vector<hsize_t>& shape, const void* values,
             bool chunked) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const Id space(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (chunked) {
    std::vector<hsize_t> chunk;
    for (const hsize_t extent : shape) chunk.push_back(std::clamp<hsize_t>(extent, 1, 16));
    H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
    H5Pset_deflate(properties, 1);
  }
  const Id dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  if (dataset.valid() && values != nullptr) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void edit_dataset(hid_t file, const Part& part, const Change& change) {
  const std::string& name = part.object;
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) return;
  std::vector<hsize_t> shape;
  std::vector<char> values;
  bool real = false;
  {
    const Id dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.valid()) return;
    const Id space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose);
    shape.resize(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    // One that an earlier edit made huge.
    if (count <= 0 || count > 1 << 20 || H5Tget_size(type) != 8) return;
    real = H5Tget_class(type) == H5T_FLOAT;
    values.resize(static_cast<std::size_t>(count) * 8);
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  const hid_t type = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  const std::size_t count = values.size() / 8, place = change.bits % count;
  switch (change.kind % 9) {
    case 0:
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      return;
    case 1:
    case 2: {
      // The low bits choose the element, all of them its value.
      const std::uint64_t value = change.kind % 9 == 1 ? change.bits : change.bits >> 40;
      std::memcpy(values.data() + 8 * place, &value, 8);
      return replace(file, name, type, shape, values.data(), false);
    }
    case 3:
      if (!shape.empty()) shape[0] = change.bits % (shape[0] + 1);
      return replace(file, name, type, shape, values.data(), false);
    case 4:
      return replace(file, name, real ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, shape, values.data(), false);
    case 5:
      if (shape.empty()) return;
      shape[0] = change.bits >> (change.bits % 64);
      return replace(file, name, type, shape, nullptr, true);
    case 6:
      shape.push_back(1);
      return replace(file, name, type, shape, values.data(), false);
    case 7: {
      H5Ldelete(file, name.c_str(), H5P_DEFAULT);
      const Id group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      return;
    }
    default:
      std::reverse(shape.begin(), shape.end());
      return replace(file, name, type, shape, values.data(), !shape.empty());
  }
}

}  // namespace

std::vector<Part> parts_of(const std::string& path) {
  std::vector<Part> parts;
  const Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid()) found(path + " cannot be read");
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, note_object, &parts, H5O_INFO_BASIC);
  return parts;
}

void edit(const std::string& path, const std::vector<Part>& parts, const std::uint8_t* data, std::size_t size) {
  {
    const Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    for (; size >= bytes_an_edit; data += bytes_an_edit, size -= bytes_an_edit) {
      Change change{data[0], 0};
      std::memcpy(&change.bits, data + 4, sizeof change.bits);
      const Part& part = parts[(data[1] + 256u * data[2]) % parts.size()];
      part.attribute.empty() ? edit_dataset(file, part, change) : edit_attribute(file, part, change);
    }
  }
  hdf5::seal(path, *alone());
}

}  // namespace kiln::fuzz
