#include "rom/pod/Snapshots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <stdexcept>

namespace kiln {

void Snapshots::append(ConstVectorView column) {
  if (column.extent(0) != rows_) {
    throw std::logic_error(fmt::format("snapshot {}: {} values; expected {}", count_, column.extent(0), rows_));
  }
  if (count_ == capacity_) {
    const std::size_t capacity = std::max(capacity_ + capacity_ / 4, capacity_ + 16);
    // glibc moves large blocks by remapping their pages, so growing holds no second copy.
    void* grown = std::realloc(values_.get(), std::max<std::size_t>(1, rows_ * capacity) * sizeof(double));
    if (grown == nullptr) throw std::bad_alloc();
    (void)values_.release();
    values_.reset(static_cast<double*>(grown));
    capacity_ = capacity;
  }
  std::copy_n(column.data(), rows_, values_.get() + count_ * rows_);
  ++count_;
}

MatrixView Snapshots::matrix() const { return MatrixView(values_.get(), rows_, count_); }

void Snapshots::clear() {
  values_.reset();
  count_ = capacity_ = 0;
}

}  // namespace kiln
