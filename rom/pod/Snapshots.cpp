#include "rom/pod/Snapshots.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <vector>

#include "framework/base/Collectives.hpp"
#include "rom/pod/Tsqr.hpp"

namespace kiln {
namespace {

/// Asks the system to back a block with its large pages: each fresh page of a snapshot matrix costs a fault, and of
/// 4 KiB pages they are a quarter of the time of a training. Advice only: refused, nothing changes but the time.
void advise_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  // madvise takes whole pages; 4 KiB and 64 KiB pages both divide this.
  constexpr std::uintptr_t page = 1 << 16;
  const std::uintptr_t from = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
  const std::uintptr_t to = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / page * page;
  if (from < to) (void)madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

}  // namespace

void Snapshots::append(ConstVectorView column) {
  if (column.extent(0) != rows_) {
    throw std::logic_error(fmt::format("snapshot {}: {} values; expected {}", count_, column.extent(0), rows_));
  }
  if (limit_ > 0 && count_ == limit_) compress();
  if (count_ == capacity_) {
    std::size_t capacity = std::max(capacity_ + capacity_ / 4, capacity_ + 16);
    if (limit_ > 0) capacity = std::min(capacity, limit_);
    grow(capacity);
  }
  std::copy_n(column.data(), rows_, values_.get() + count_ * rows_);
  ++count_;
  ++appended_;
}

void Snapshots::reserve(std::size_t columns) {
  if (limit_ > 0) columns = std::min(columns, limit_);
  if (columns <= capacity_) return;
  grow(columns);
  // Only here: a block that grows again is moved, and moving large pages breaks them up at more than they have saved.
  advise_large_pages(values_.get(), rows_ * capacity_ * sizeof(double));
}

void Snapshots::grow(std::size_t capacity) {
  // glibc moves large blocks by remapping their pages, so growing holds no second copy.
  void* grown = std::realloc(values_.get(), std::max<std::size_t>(1, rows_ * capacity) * sizeof(double));
  if (grown == nullptr) throw std::bad_alloc();
  (void)values_.release();
  values_.reset(static_cast<double*>(grown));
  capacity_ = capacity;
}

void Snapshots::limit(int columns, Teuchos::RCP<const Communicator> communicator) {
  if (columns < 2) throw std::logic_error(fmt::format("snapshots limited to {} columns; expected at least 2", columns));
  limit_ = static_cast<std::size_t>(columns);
  communicator_ = std::move(communicator);
}

void Snapshots::compress() {
  const Tsqr factors(matrix(), *communicator_);
  std::vector<double> values(std::min(factors.r().extent(0), count_));
  MatrixView directions("kiln::rom::directions", factors.r().extent(0), values.size());
  if (communicator_->getRank() == 0) {
    const dense::Svd svd = dense::svd(factors.r());
    values = svd.values;
    Kokkos::deep_copy(directions, svd.left);
  }
  broadcast(*communicator_, 0, values.data(), values.size());
  broadcast(*communicator_, 0, directions.data(), directions.size());
  double energy = 0.0;
  for (const double value : values) energy += value * value;
  appended_energy_ = energy + discarded_;

  constexpr double round_off = std::numeric_limits<double>::epsilon();
  std::size_t kept = std::min(values.size(), limit_ / 2);
  while (kept > 1 && !(values[kept - 1] > round_off * values.front())) --kept;
  for (std::size_t k = kept; k < values.size(); ++k) discarded_ += values[k] * values[k];
  for (std::size_t k = 0; k < kept; ++k) {
    for (std::size_t i = 0; i < directions.extent(0); ++i) directions(i, k) *= values[k];
  }
  const MatrixView leading = factors.apply(dense::leading_columns(ConstMatrixView(directions), kept));
  std::copy_n(leading.data(), leading.size(), values_.get());
  count_ = kept;
}

MatrixView Snapshots::matrix() const { return MatrixView(values_.get(), rows_, count_); }

void Snapshots::restart() {
  count_ = appended_ = 0;
  discarded_ = appended_energy_ = 0.0;
}

void Snapshots::clear() {
  restart();
  values_.reset();
  capacity_ = 0;
}

}  // namespace kiln
