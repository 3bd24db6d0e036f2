#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

/// A thin layer over HDF5's C interface: handles that close themselves, errors that name file and object, and the two
/// kinds of data Kiln writes: replicated (small, the same on every rank) and distributed by a Tpetra map.
namespace kiln::hdf5 {

struct Node;
struct Dataset;

/// A dataset that is kept open, for many blocks: opening it takes longer than writing a small one.
class OpenedDataset {
 public:
  OpenedDataset(std::shared_ptr<Node> node, std::string name);
  /// As Group::write_block. Collective.
  void write_block(const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                   const std::vector<double>& values);
  void write_block(const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                   const std::vector<long long>& values);

 private:
  std::shared_ptr<Node> node_;
  std::string name_;
  std::shared_ptr<Dataset> dataset_;
};

template <class T>
struct Array {
  std::vector<std::size_t> shape;
  std::vector<T> values;  ///< row-major
};

/// A group of an open file. All calls are collective over the file's communicator. Reading throws FileError that names
/// the object for what is missing or has another type or shape; writing throws one for what the disk refuses.
class Group {
 public:
  bool has(const std::string& name) const;
  Group group(const std::string& name) const;
  Group create_group(const std::string& name);
  /// Of groups and datasets, sorted.
  std::vector<std::string> names() const;
  const std::string& file() const;
  const std::string& path() const;
  const Communicator& communicator() const;

  /// Rank 0's value is written; one that is there already is replaced.
  void attribute(const std::string& name, const std::string& value);
  void attribute(const std::string& name, const char* value) { attribute(name, std::string(value)); }
  void attribute(const std::string& name, double value);
  void attribute(const std::string& name, long long value);
  void attribute(const std::string& name, int value) { attribute(name, static_cast<long long>(value)); }
  void attribute(const std::string& name, const std::vector<long long>& values);
  /// A text in the fixed-length ASCII form that some readers insist on.
  void ascii_attribute(const std::string& name, const std::string& value);
  /// Attribute of a dataset of this group, e.g. its unit.
  void attribute_of(const std::string& dataset, const std::string& name, const std::string& value);
  bool has_attribute(const std::string& name) const;
  std::vector<std::string> attribute_names() const;
  std::string text(const std::string& attribute) const;
  double real(const std::string& attribute) const;
  long long integer(const std::string& attribute) const;
  /// Also check that the number is finite, or within bounds.
  double finite_real(const std::string& attribute) const;
  long long integer(const std::string& attribute, long long lowest, long long highest) const;
  std::string text_of(const std::string& dataset, const std::string& attribute) const;

  /// Replicated data; rank 0's values are written.
  void write(const std::string& name, const Array<double>& array);
  void write(const std::string& name, const Array<long long>& array);
  void write(const std::string& name, const std::vector<double>& values);
  void write(const std::string& name, const std::vector<long long>& values);
  Array<double> reals(const std::string& name) const;
  Array<long long> integers(const std::string& name) const;
  /// Also checks the shape; an entry of 0 matches any length.
  Array<double> reals(const std::string& name, const std::vector<std::size_t>& shape) const;
  Array<long long> integers(const std::string& name, const std::vector<std::size_t>& shape) const;
  /// Also checks that all values are finite.
  Array<double> finite_reals(const std::string& name, const std::vector<std::size_t>& shape) const;
  std::vector<std::size_t> shape(const std::string& name) const;
  /// Whether the object of this name is a dataset of floating-point numbers, or of integers.
  bool holds_reals(const std::string& name) const;
  bool holds_integers(const std::string& name) const;

  /// Distributed data, one dataset row for each particle of `map`, in ascending order of global ids whatever the
  /// number of ranks. Each particle lies on one rank. values: local particles × columns.
  void write_rows(const std::string& name, const Map& map, ConstMatrixView values);
  /// Reads the rows of `map`'s particles; the dataset's row i belongs to global id i. Particles may lie on many ranks.
  /// The dataset has rows × columns, or rows alone (one column).
  MatrixView read_rows(const std::string& name, const Map& map) const;

  /// A dataset of full size, contiguous and allocated at once: writing blocks into it later changes no metadata, so
  /// that the file stays readable should the program be killed in between. Unwritten entries are `fill`.
  void create_reals(const std::string& name, const std::vector<std::size_t>& shape, double fill);
  void create_integers(const std::string& name, const std::vector<std::size_t>& shape, long long fill);
  void create_bytes(const std::string& name, const std::vector<std::size_t>& shape, unsigned char fill);
  /// One-dimensional datasets "0", "1", … in this group, each of which shows a row of the two-dimensional dataset of
  /// reals at the absolute path `dataset` and stores nothing itself (HDF5's virtual layout).
  void create_row_views(const std::string& dataset);
  /// A second name for the object at the absolute path `target`.
  void link(const std::string& name, const std::string& target);
  /// Writes this rank's block of a dataset; blocks of ranks may not overlap and may be empty. values: row-major.
  void write_block(const std::string& name, const std::vector<std::size_t>& start,
                   const std::vector<std::size_t>& count, const std::vector<double>& values);
  void write_block(const std::string& name, const std::vector<std::size_t>& start,
                   const std::vector<std::size_t>& count, const std::vector<long long>& values);
  OpenedDataset opened(const std::string& name) const;
  /// Reads this rank's block of a dataset of floating-point numbers.
  std::vector<double> read_block(const std::string& name, const std::vector<std::size_t>& start,
                                 const std::vector<std::size_t>& count) const;

 protected:
  explicit Group(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

/// An HDF5 file. Closes when the last of it and its groups goes.
class File : public Group {
 public:
  /// A new file, written by all ranks; replaces an existing one. Throws FileError.
  static File create(const std::string& path, const Teuchos::RCP<const Communicator>& communicator);
  /// Throws FileError for a missing file and for one that is not HDF5, damaged or cut short. A sealed file (Seal.hpp)
  /// is compared with its seal; any other is vetted (Hdf5Vet.hpp).
  static File read(const std::string& path, const Teuchos::RCP<const Communicator>& communicator);
  static File modify(const std::string& path, const Teuchos::RCP<const Communicator>& communicator);
  /// Throws FileError unless the file was opened by read() and carries a seal.
  void require_seal() const;
  /// Tells a sealed file that read() has opened from others (Seal.hpp); empty: it carries no seal.
  const std::string& fingerprint() const;
  /// Hands everything written so far to the operating system. Throws FileError when the disk refuses; closing cannot.
  void flush();
  /// Errors call the open file by this name from now on.
  void was_renamed(const std::string& path);

 private:
  using Group::Group;
};

}  // namespace kiln::hdf5
