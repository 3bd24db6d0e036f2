#include "rom/basis/AffineBasis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "rom/linear_algebra/Dense.hpp"

namespace kiln {
AffineBasis::AffineBasis(ConstVectorView reference, ConstMatrixView modes, int first,
                         std::shared_ptr<const TrialSpace> previous)
    : reference_(reference), modes_(modes), first_(first), previous_(std::move(previous)) {
  const int columns = static_cast<int>(modes.extent(1));
  if (reference.extent(0) != modes.extent(0) || first < 0 || first > columns) {
    throw std::logic_error(
        fmt::format("an affine basis of {} rows and {} columns has a reference state of {} entries and begins at {}",
                    modes.extent(0), columns, reference.extent(0), first));
  }
  if (previous_ != nullptr && previous_->first() + previous_->size() != first) {
    throw std::logic_error(fmt::format("an affine basis begins at column {}, and the window before it ends at {}",
                                       first, previous_->first() + previous_->size()));
  }
  tangent_ = Kokkos::subview(modes_, Kokkos::ALL, std::make_pair(first, columns));
  earlier_ = VectorView("kiln::rom::coordinates of earlier windows", first);
  beginning_ = VectorView("kiln::rom::state at the window's beginning", reference.extent(0));
  std::copy_n(reference_.data(), reference_.extent(0), beginning_.data());
}

void AffineBasis::begin_at(ConstVectorView earlier) const {
  std::copy_n(earlier.data(), first_, earlier_.data());
  if (previous_ != nullptr) return previous_->state(earlier, beginning_);
  std::copy_n(reference_.data(), reference_.extent(0), beginning_.data());
  const ConstVectorView known = Kokkos::subview(earlier, std::make_pair(0, first_));
  dense::multiply(1.0, dense::leading_columns(modes_, first_), known, 1.0, beginning_);
}

void AffineBasis::state(ConstVectorView x, VectorView u) const {
  if (std::memcmp(x.data(), earlier_.data(), first_ * sizeof(double)) != 0) begin_at(x);
  dense::affine(beginning_, tangent_, x.data() + first_, u.data());
}

std::unique_ptr<TrialSpace> AffineBasis::restricted(const std::vector<LocalIndex>& particles, int components) const {
  const VectorView reference("kiln::rom::reference", particles.size() * components);
  const MatrixView modes("kiln::rom::modes", particles.size() * components, modes_.extent(1));
  for (std::size_t k = 0; k < modes.extent(1); ++k) {
    for (std::size_t i = 0; i < reference.extent(0); ++i) {
      modes(i, k) = modes_(particles[i / components] * components + i % components, k);
    }
  }
  for (std::size_t i = 0; i < reference.extent(0); ++i) {
    reference(i) = reference_(particles[i / components] * components + i % components);
  }
  return std::make_unique<AffineBasis>(reference, modes, first_);
}

}  // namespace kiln
