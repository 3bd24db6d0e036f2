#include "rom/basis/AffineBasis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "rom/linear_algebra/Dense.hpp"

namespace kiln {

AffineBasis::AffineBasis(VectorView reference, MatrixView modes) : reference_(reference), modes_(modes) {
  if (reference.extent(0) != modes.extent(0)) {
    throw std::logic_error(fmt::format("an affine basis of {} rows has a reference state of {} entries",
                                       modes.extent(0), reference.extent(0)));
  }
}

void AffineBasis::state(ConstVectorView coordinates, VectorView u) const {
  std::copy_n(reference_.data(), reference_.extent(0), u.data());
  dense::multiply(1.0, modes_, coordinates, 1.0, u);
}

ConstMatrixView AffineBasis::tangent(ConstVectorView) const { return modes_; }

}  // namespace kiln
