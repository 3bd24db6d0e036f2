#include "rom/pod/Tsqr.hpp"

#include <algorithm>

#include "framework/base/Collectives.hpp"

namespace kiln {

Tsqr::Tsqr(MatrixView a, const Communicator& communicator) : local_(a), rows_(a.extent(0)) {
  const std::size_t columns = a.extent(1);
  const MatrixView local_r = local_.r();
  const std::vector<std::vector<double>> factors =
      gathered(communicator, std::vector<double>(local_r.data(), local_r.data() + local_r.size()));
  const auto height = [columns](const std::vector<double>& r) { return columns == 0 ? 0 : r.size() / columns; };
  std::size_t total = 0;
  for (const std::vector<double>& r : factors) total += height(r);
  MatrixView stack("kiln::rom::stacked R", total, columns);
  std::size_t top = 0, own_top = 0;
  for (int rank = 0; rank < communicator.getSize(); ++rank) {
    const std::vector<double>& r = factors[rank];
    for (std::size_t j = 0; j < columns; ++j)
      std::copy_n(r.data() + j * height(r), height(r), stack.data() + j * total + top);
    if (rank == communicator.getRank()) own_top = top;
    top += height(r);
  }

  const std::size_t rank_of_r = std::min(total, columns);
  MatrixView q("kiln::rom::stacked Q", total, rank_of_r);
  r_ = MatrixView("kiln::rom::R", rank_of_r, columns);
  if (communicator.getRank() == 0) {
    const dense::HouseholderQr second(stack);
    Kokkos::deep_copy(r_, second.r());
    for (std::size_t k = 0; k < rank_of_r; ++k) {
      const double sign = r_(k, k) < 0.0 ? -1.0 : 1.0;
      for (std::size_t j = 0; j < columns; ++j) r_(k, j) *= sign;
      q(k, k) = sign;
    }
    second.apply_q(q);
  }
  // One rank's factors for all: processors that round differently would otherwise disagree about Q.
  broadcast(communicator, 0, r_.data(), r_.size());
  broadcast(communicator, 0, q.data(), q.size());
  stacked_q_ = dense::row_block(q, own_top, local_r.extent(0));
}

MatrixView Tsqr::apply(const ConstMatrixView& c) const {
  MatrixView result("kiln::rom::Q c", rows_, c.extent(1));
  dense::product(dense::Transpose::no, dense::Transpose::no, 1.0, stacked_q_, c, 0.0,
                 dense::row_block(result, 0, stacked_q_.extent(0)));
  local_.apply_q(result);
  return result;
}

void orthonormalise(const MatrixView& a, const Communicator& communicator) {
  MatrixView copy("kiln::rom::columns", a.extent(0), a.extent(1));
  Kokkos::deep_copy(copy, a);
  const Tsqr factors(copy, communicator);
  const std::size_t columns = a.extent(1);
  MatrixView identity("kiln::rom::identity", factors.r().extent(0), columns);
  for (std::size_t k = 0; k < std::min(columns, identity.extent(0)); ++k) identity(k, k) = 1.0;
  Kokkos::deep_copy(a, factors.apply(identity));
}

}  // namespace kiln
