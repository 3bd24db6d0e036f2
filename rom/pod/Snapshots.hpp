#pragma once

#include <cstdlib>
#include <memory>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A snapshot matrix S: this rank's rows of the columns collected so far, column-major and contiguous. Grows by a
/// quarter at a time; pages not written to take no memory, and large blocks are moved by remapping, not by copying.
///
/// With a limit it never holds more columns than that: full, it replaces them by their leading left singular vectors
/// times the singular values, at most half as many, and goes on collecting. S Sᵀ, and with it the POD, stays the same
/// but for what these leave out, which discarded_energy() tells (one-pass incremental SVD: Brand 2002; Baker, Gallivan,
/// Van Dooren 2012).
class Snapshots {
 public:
  /// `rows`: length of this rank's part of each column.
  explicit Snapshots(std::size_t rows) : rows_(rows) {}

  /// Never holds more than `columns`, at least 2, from now on; its columns' rows are spread over `communicator`, which
  /// makes `append` collective.
  void limit(int columns, Teuchos::RCP<const Communicator> communicator);

  /// Room for `columns` (at most the limit) from now on, asked for in the system's large pages: growing to them a
  /// quarter at a time costs a fault for each small one.
  void reserve(std::size_t columns);

  /// Adds a column. Throws std::logic_error for another length.
  void append(ConstVectorView column);
  std::size_t rows() const { return rows_; }
  /// Columns held.
  std::size_t count() const { return count_; }
  /// Columns appended since the last restart() or clear().
  std::size_t appended() const { return appended_; }
  /// Σσ² of the singular vectors left out, relative to Σσ² of all that was appended up to the last merge.
  double discarded_energy() const { return discarded_ > 0.0 ? discarded_ / appended_energy_ : 0.0; }
  /// rows × count; valid until the next append.
  MatrixView matrix() const;
  /// No columns are left; their memory stays for the next ones, since a system's fresh pages cost more than the copy.
  void restart();
  /// No columns are left, and their memory is freed.
  void clear();

 private:
  struct Free {
    void operator()(double* values) const { std::free(values); }
  };
  void compress();
  void grow(std::size_t capacity);

  std::size_t rows_;
  std::size_t count_ = 0;
  std::size_t appended_ = 0;
  std::size_t limit_ = 0;  ///< 0: none
  double discarded_ = 0.0, appended_energy_ = 0.0;
  Teuchos::RCP<const Communicator> communicator_;
  std::size_t capacity_ = 0;
  std::unique_ptr<double, Free> values_;
};

}  // namespace kiln
