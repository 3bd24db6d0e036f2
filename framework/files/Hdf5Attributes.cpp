#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Hdf5Node.hpp"
#include "framework/files/Reserve.hpp"

namespace kiln::hdf5 {
namespace {

/// Texts have variable length: the fixed kind must fit into an object header of 64 KiB, an input file need not.
Id text_type() {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::string place(const Node& node, const std::string& owner, const std::string& attribute) {
  return (owner.empty() ? node.path : node.path_of(owner)) + " attribute '" + attribute + "'";
}

Id scalar() { return Id(H5Screate(H5S_SCALAR), H5Sclose); }

/// Metadata: all ranks must write the same value. An empty `owner` is the group itself.
void write_attribute(const Node& node, const std::string& owner, const std::string& name, hid_t type, hid_t space,
                     const void* value) {
  bool written = false;
  const Id object(H5Oopen(node.id, owner.empty() ? "." : owner.c_str(), H5P_DEFAULT), H5Oclose);
  if (object.valid()) {
    if (H5Aexists(object, name.c_str()) > 0) H5Adelete(object, name.c_str());
    const Id attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    written = attribute.valid() && H5Awrite(attribute, type, value) >= 0;
  }
  if (!written) note_failed_writing();
  const std::string why = written ? "" : reason();
  throw_together(
      node.communicator(), node.file->path,
      written ? std::nullopt : std::optional<Fault>(Fault{place(node, owner, name), "cannot be written" + why, ""}));
}

void write_text(const Node& node, const std::string& owner, const std::string& name, const std::string& value) {
  const std::string text = broadcast(node.communicator(), value);
  const char* start = text.c_str();
  write_attribute(node, owner, name, text_type(), scalar(), &start);
}

template <class T>
void write_number(const Node& node, const std::string& name, hid_t type, T value) {
  Teuchos::broadcast(node.communicator(), 0, 1, &value);
  write_attribute(node, "", name, type, scalar(), &value);
}

struct Attribute {
  Id object;
  Id id;
  Id type;
  H5T_class_t kind;
};

Attribute open_attribute(const Node& node, const std::string& owner, const std::string& name,
                         const std::string& expected) {
  const std::string& file = node.file->path;
  Id object(H5Oopen(node.id, owner.empty() ? "." : owner.c_str(), H5P_DEFAULT), H5Oclose);
  H5Eclear2(H5E_DEFAULT);
  if (!object.valid()) node.fail(owner, "is missing", "an object with the attribute '" + name + "'");
  if (H5Aexists(object, name.c_str()) <= 0) throw FileError(file, place(node, owner, name), "is missing", expected);
  Id id(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!id.valid()) throw FileError(file, place(node, owner, name), "cannot be read" + reason());
  Id type(H5Aget_type(id), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  const Id space(H5Aget_space(id), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) {
    throw FileError(file, place(node, owner, name), "holds more or less than one value", expected);
  }
  return {std::move(object), std::move(id), std::move(type), kind};
}

template <class T>
T read_number(const Node& node, const std::string& name, hid_t type, bool accept_reals, const std::string& expected) {
  const Attribute attribute = open_attribute(node, "", name, expected);
  if (attribute.kind != H5T_INTEGER && !(accept_reals && attribute.kind == H5T_FLOAT)) {
    throw FileError(node.file->path, place(node, "", name), "has another type", expected);
  }
  T value{};
  if (H5Aread(attribute.id, type, &value) < 0) {
    throw FileError(node.file->path, place(node, "", name), "cannot be read" + reason());
  }
  return value;
}

std::string read_text(const Node& node, const std::string& owner, const std::string& name) {
  const Attribute attribute = open_attribute(node, owner, name, "a text");
  if (attribute.kind != H5T_STRING) {
    throw FileError(node.file->path, place(node, owner, name), "has another type", "a text");
  }
  const auto unreadable = [&] {
    return FileError(node.file->path, place(node, owner, name), "cannot be read" + reason());
  };
  if (H5Tis_variable_str(attribute.type) > 0) {
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5Tget_cset(attribute.type));
    char* found = nullptr;
    if (H5Aread(attribute.id, type, &found) < 0) throw unreadable();
    std::string text = found == nullptr ? "" : found;
    H5free_memory(found);
    return text;
  }
  std::string text(H5Tget_size(attribute.type), '\0');
  if (H5Aread(attribute.id, attribute.type, text.data()) < 0) throw unreadable();
  return text.substr(0, text.find('\0'));
}

}  // namespace

void Group::attribute(const std::string& name, const std::string& value) { write_text(*node_, "", name, value); }
void Group::attribute(const std::string& name, double value) { write_number(*node_, name, H5T_NATIVE_DOUBLE, value); }
void Group::attribute(const std::string& name, long long value) { write_number(*node_, name, H5T_NATIVE_LLONG, value); }

void Group::attribute(const std::string& name, const std::vector<long long>& values) {
  const hsize_t length = values.size();
  const Id space(H5Screate_simple(1, &length, nullptr), H5Sclose);
  write_attribute(*node_, "", name, H5T_NATIVE_LLONG, space, values.data());
}

void Group::ascii_attribute(const std::string& name, const std::string& value) {
  const std::string text = broadcast(node_->communicator(), value);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  write_attribute(*node_, "", name, type, scalar(), text.c_str());
}

void Group::attribute_of(const std::string& dataset, const std::string& name, const std::string& value) {
  write_text(*node_, dataset, name, value);
}

bool Group::has_attribute(const std::string& name) const { return H5Aexists(node_->id, name.c_str()) > 0; }

std::vector<std::string> Group::attribute_names() const {
  std::vector<std::string> found;
  const herr_t status = H5Aiterate2(
      node_->id, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &found);
  if (status < 0) node_->fail("", "its attributes cannot be listed" + reason());
  return found;
}

std::string Group::text(const std::string& attribute) const { return read_text(*node_, "", attribute); }

double Group::real(const std::string& attribute) const {
  return read_number<double>(*node_, attribute, H5T_NATIVE_DOUBLE, true, "a number");
}

long long Group::integer(const std::string& attribute) const {
  return read_number<long long>(*node_, attribute, H5T_NATIVE_LLONG, false, "an integer");
}

double Group::finite_real(const std::string& attribute) const {
  const double value = real(attribute);
  if (!std::isfinite(value)) {
    throw FileError(file(), place(*node_, "", attribute), fmt::format("is {}", value), "a finite number");
  }
  return value;
}

long long Group::integer(const std::string& attribute, long long lowest, long long highest) const {
  const long long value = integer(attribute);
  if (value < lowest || value > highest) {
    throw FileError(file(), place(*node_, "", attribute), fmt::format("is {}", value),
                    fmt::format("{} to {}", lowest, highest));
  }
  return value;
}

std::string Group::text_of(const std::string& dataset, const std::string& attribute) const {
  return read_text(*node_, dataset, attribute);
}

}  // namespace kiln::hdf5
