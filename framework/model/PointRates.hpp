#pragma once

#include <memory>

#include "framework/model/Model.hpp"
#include "framework/model/ParameterPoints.hpp"

namespace kiln {

/// A model evaluated at several parameter points at once, each with a state of its own. What Model::rate says of one
/// point holds for each; the points' values lie side by side, so that they can go through a model's loops as the lanes
/// of vectors.
class PointRates {
 public:
  virtual ~PointRates() = default;
  /// f(u_p, t; µ_p) of every point p. u: points by sources × components; f: points by rows × components, overwritten;
  /// both with the points' values next to each other. A point's values depend on no other point's. The model's live
  /// parameters are left at any of the points' values.
  virtual void rates(ConstMatrixView u, double time, MatrixView f) = 0;
};

/// The points one after the other: right for every model. The model must outlive the result. Throws as Parameters::set
/// for a name the model does not have.
std::unique_ptr<PointRates> one_after_the_other(Model& model, const ParameterPoints& points);

/// values(point, :), as a vector, and back.
void take_point(ConstMatrixView values, std::size_t point, VectorView one);
void put_point(ConstVectorView one, std::size_t point, MatrixView values);

}  // namespace kiln
