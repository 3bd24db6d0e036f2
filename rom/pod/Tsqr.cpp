#include "rom/pod/Tsqr.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>

namespace kiln {

Tsqr::Tsqr(MatrixView a, const Communicator& communicator) : local_(a), rows_(a.extent(0)) {
  const std::size_t columns = a.extent(1);
  const MatrixView local_r = local_.r();
  const int mine = static_cast<int>(local_r.extent(0));
  std::vector<int> counts(communicator.getSize());
  Teuchos::gatherAll(communicator, 1, &mine, static_cast<int>(counts.size()), counts.data());
  std::size_t first = 0, total = 0;
  for (int rank = 0; rank < communicator.getSize(); ++rank) {
    if (rank == communicator.getRank()) first = total;
    total += counts[rank];
  }

  // Each rank's block of rows added to zeros: a gather in the one collective that Teuchos has for it.
  MatrixView stack("kiln::rom::stacked R", total, columns);
  for (std::size_t j = 0; j < columns; ++j)
    std::copy_n(local_r.data() + j * mine, mine, stack.data() + j * total + first);
  dense::sum_over_ranks(communicator, stack.data(), stack.size());

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
  dense::broadcast(communicator, r_.data(), r_.size());
  dense::broadcast(communicator, q.data(), q.size());
  stacked_q_ = dense::row_block(q, first, mine);
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
