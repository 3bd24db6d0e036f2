#include "rom/projection/PointStates.hpp"

#include <algorithm>
#include <stdexcept>

#include "rom/projection/PointProducts.hpp"

namespace kiln {

PointStates::PointStates(std::size_t points, const TrialSpace& space) : space_(space) {
  if (!space.affine()) throw std::logic_error("PointStates: the trial space is not affine");
  const VectorView anywhere("kiln::rom::coordinates of a point", space.first() + space.size());
  tangent_ = uncounted(space.tangent(anywhere));
  beginning_ = MatrixView("kiln::rom::states of points at the window's beginning", points, tangent_.extent(0));
}

void PointStates::begin(ConstMatrixView x) {
  const VectorView one("kiln::rom::coordinates of a point", x.extent(1));
  const VectorView state("kiln::rom::state of a point", size());
  for (std::size_t point = 0; point < x.extent(0); ++point) {
    take_point(x, point, one);
    std::fill_n(one.data() + space_.first(), space_.size(), 0.0);
    space_.state(one, state);
    put_point(state, point, beginning_);
  }
}

void PointStates::states(ConstMatrixView x, const PointMask& wanted, MatrixView u) const {
  PointProduct(tangent_).add(beginning_, own_coordinates(x, space_), wanted, u);
}

}  // namespace kiln
