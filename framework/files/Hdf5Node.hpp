#pragma once

#include <hdf5.h>
#include <mpi.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/files/Hdf5.hpp"
#include "framework/files/Seal.hpp"
#include "framework/files/Together.hpp"

/// What the .cpp files of the HDF5 layer share; nobody else includes this.
namespace kiln::hdf5 {

/// An HDF5 identifier that closes itself.
class Id {
 public:
  using Close = herr_t (*)(hid_t);
  Id(hid_t id, Close close) : id_(id), close_(close) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

struct OpenFile {
  std::string path;
  Teuchos::RCP<const Communicator> communicator;
  bool parallel;  ///< opened through MPI-IO
  Id id;
  std::vector<Segment> seal = {};  ///< rank 0's; empty: none, or unknown
  std::string fingerprint = {};    ///< of the seal, the same on every rank; empty: none, or unknown
  std::vector<bool> checked = {};  ///< rank 0's: segments that were found intact
};

/// A group of an open file.
struct Node {
  std::shared_ptr<OpenFile> file;
  std::string path;
  Id id;

  const Communicator& communicator() const { return *file->communicator; }
  std::string path_of(const std::string& name) const { return path == "/" ? path + name : path + "/" + name; }
  /// Throws FileError for the object `name` of this group.
  [[noreturn]] void fail(const std::string& name, const std::string& found, const std::string& expected = {}) const;
  /// Throws on every rank if an HDF5 call failed on any. Collective.
  void require(bool succeeded, const std::string& name, const std::string& done) const;
};

/// The innermost reason on HDF5's error stack, in brackets with a space in front, or nothing.
std::string reason();
MPI_Comm mpi_communicator(const Communicator& communicator);

/// A dataset that was found and opened.
struct Dataset {
  Id id;
  std::vector<std::size_t> shape;
  H5T_class_t type;
};
Dataset open_dataset(const Node& node, const std::string& name);
/// Throws FileError if the dataset is not of floating-point numbers (H5T_FLOAT) or integers (H5T_INTEGER).
Dataset open_dataset(const Node& node, const std::string& name, H5T_class_t type);
/// Compares a large dataset's values with the file's seal, if there is one: once. Collective.
void check_values(const Node& node, const Dataset& dataset, const std::string& name);
/// "3 × 4", or "a single value".
std::string shape_text(const std::vector<std::size_t>& shape);

/// This rank's part of a dataset; ranks with an empty part take part in the call nonetheless.
std::vector<double> read_slab(const Node& node, const Dataset& dataset, const std::string& name,
                              const std::vector<std::size_t>& start, const std::vector<std::size_t>& count);
/// `type` is HDF5's in-memory type of `values`.
void write_slab(const Node& node, const Dataset& dataset, const std::string& name,
                const std::vector<std::size_t>& start, const std::vector<std::size_t>& count, hid_t type,
                const void* values);
/// Creates a dataset; `fill` may be null. Contiguous; `early` allocates its space at once.
void create_dataset(const Node& node, const std::string& name, hid_t type, const std::vector<std::size_t>& shape,
                    const void* fill, bool early);

}  // namespace kiln::hdf5
