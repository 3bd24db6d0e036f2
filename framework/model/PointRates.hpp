#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "framework/model/Model.hpp"
#include "framework/model/ParameterPoints.hpp"

namespace kiln {

/// Of each of several points: 1 where a call is for it, else 0.
using PointMask = std::vector<char>;

/// Whether a call is for any of the points first … first + count − 1.
inline bool any_wanted(const PointMask& mask, std::size_t first, std::size_t count) {
  const auto begin = mask.begin() + static_cast<std::ptrdiff_t>(first);
  return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count), [](char wanted) { return wanted != 0; });
}

/// A model evaluated at several parameter points at once, each with a state of its own. What Model::rate says of one
/// point holds for each; the points' values lie side by side, so that they can go through a model's loops as the lanes
/// of vectors.
class PointRates {
 public:
  virtual ~PointRates() = default;
  /// f(u_p, t; µ_p) of every wanted point p. u: points by sources × components; f: points by rows × components, of
  /// points not wanted overwritten or not; both with the points' values next to each other. A point's values depend on
  /// no other point's. The model's live parameters are left at any of the points' values.
  virtual void rates(ConstMatrixView u, double time, const PointMask& wanted, MatrixView f) = 0;
  /// Goes over to other points, of the same number.
  virtual void take(const ParameterPoints& points) = 0;
};

/// The points one after the other: right for every model. The model must outlive the result. Throws as Parameters::set
/// for a name the model does not have.
std::unique_ptr<PointRates> one_after_the_other(Model& model, const ParameterPoints& points);

/// values(point, :), as a vector, and back.
void take_point(ConstMatrixView values, std::size_t point, VectorView one);
void put_point(ConstVectorView one, std::size_t point, MatrixView values);

}  // namespace kiln
