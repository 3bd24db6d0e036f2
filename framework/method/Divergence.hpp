#pragma once

#include <string>

#include "framework/base/Error.hpp"
#include "framework/model/Model.hpp"

namespace kiln {

/// Whether neither array holds a NaN or an infinity on any rank. Collective.
bool all_finite(const Communicator& communicator, ConstVectorView a, ConstVectorView b);

/// The error of a model's solve at `time`: `what`, and the particle to look at, the same on every rank. That is the one
/// of lowest id whose state u, rate f or `measure` is not finite, or else the one where `measure` (a residual) is
/// largest. All three arrays are rows × components. Collective.
DivergenceError divergence(const Model& model, const std::string& what, double time, ConstVectorView u,
                           ConstVectorView f, ConstVectorView measure);

}  // namespace kiln
