#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

/// What ranks tell each other in arrays of any length, which MPI's int counts need not hold. All of it is collective.
namespace kiln {

/// Calls body(first, length) for each piece of an array of `count` elements that one message holds.
template <class Body>
void in_pieces(std::size_t count, const Body& body) {
  constexpr std::size_t longest = std::size_t{1} << 22;
  for (std::size_t first = 0; first < count; first += longest) {
    body(first, static_cast<int>(std::min(longest, count - first)));
  }
}

/// Gives every rank the `count` values that the rank `root` holds.
template <class T>
void broadcast(const Communicator& communicator, int root, T* values, std::size_t count) {
  in_pieces(count,
            [&](std::size_t first, int length) { Teuchos::broadcast(communicator, root, length, values + first); });
}

/// Gives every rank the vector or string that the rank `root` holds, whatever length the others have.
template <class Array>
void broadcast(const Communicator& communicator, int root, Array& array) {
  auto count = static_cast<long long>(array.size());
  Teuchos::broadcast(communicator, root, 1, &count);
  array.resize(static_cast<std::size_t>(count));
  broadcast(communicator, root, array.data(), array.size());
}

/// Sums an array over all ranks, in place.
template <class T>
void sum_over_ranks(const Communicator& communicator, T* values, std::size_t count) {
  if (communicator.getSize() == 1) return;
  std::vector<T> sum;
  in_pieces(count, [&](std::size_t first, int length) {
    sum.resize(length);
    Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, length, values + first, sum.data());
    std::copy_n(sum.data(), length, values + first);
  });
}

/// The Euclidean norm of a distributed array from each rank's sum of squares.
inline double root_of_sum(const Communicator& communicator, double squares) {
  double total = squares;
  if (communicator.getSize() > 1) Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, 1, &squares, &total);
  return std::sqrt(total);
}

/// The vectors or strings of all ranks, in the order of the ranks, on each rank.
template <class Array>
std::vector<Array> gathered(const Communicator& communicator, const Array& own) {
  std::vector<Array> all(communicator.getSize());
  for (int rank = 0; rank < communicator.getSize(); ++rank) {
    if (rank == communicator.getRank()) all[rank] = own;
    broadcast(communicator, rank, all[rank]);
  }
  return all;
}

/// The vectors of all ranks one after the other, in the order of the ranks, on each rank.
template <class T>
std::vector<T> concatenated(const Communicator& communicator, const std::vector<T>& own) {
  std::vector<T> all;
  for (const std::vector<T>& one : gathered(communicator, own)) all.insert(all.end(), one.begin(), one.end());
  return all;
}

}  // namespace kiln
