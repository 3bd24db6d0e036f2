#pragma once

#include <cstdlib>
#include <memory>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A snapshot matrix: this rank's rows of the columns collected so far, column-major and contiguous. Grows by a quarter
/// at a time; pages not written to take no memory, and large blocks are moved by remapping, not by copying.
class Snapshots {
 public:
  /// `rows`: length of this rank's part of each column.
  explicit Snapshots(std::size_t rows) : rows_(rows) {}

  /// Adds a column. Throws std::logic_error for another length.
  void append(ConstVectorView column);
  std::size_t rows() const { return rows_; }
  std::size_t count() const { return count_; }
  /// rows × count; valid until the next append.
  MatrixView matrix() const;
  /// Frees the memory; no columns are left.
  void clear();

 private:
  struct Free {
    void operator()(double* values) const { std::free(values); }
  };
  std::size_t rows_;
  std::size_t count_ = 0;
  std::size_t capacity_ = 0;
  std::unique_ptr<double, Free> values_;
};

}  // namespace kiln
