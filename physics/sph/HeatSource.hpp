#pragma once

#include <functional>
#include <memory>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Parameters.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {

/// A heat source at several parameter points at once.
class PointFluxes {
 public:
  virtual ~PointFluxes() = default;
  /// HeatSource::flux of each point. q: points × positions, with the points' values next to each other; overwritten.
  virtual void flux(double time, ConstPositionView positions, MatrixView q) = 0;
};

/// Heat flux into the heated surface, q of Eq. 9.
class HeatSource {
 public:
  using Context = NoContext;
  static constexpr const char* category = "heat source";

  HeatSource() = default;
  // Live parameters point into the object.
  HeatSource(const HeatSource&) = delete;
  HeatSource& operator=(const HeatSource&) = delete;
  virtual ~HeatSource() = default;

  /// q in W/m² at each position (m) at a time (s); overwritten. Depends on these and on the parameters alone: for one
  /// time it is asked once.
  virtual void flux(double time, ConstPositionView positions, VectorView q) const = 0;

  /// Whether heat may enter at all, for some values of the parameters.
  virtual bool heats() const { return true; }

  /// Gives the live parameters their values at a point.
  using SetPoint = std::function<void(std::size_t point)>;
  /// This source at `count` points, at least one. It must outlive the result.
  virtual std::unique_ptr<PointFluxes> at_points(std::size_t count, SetPoint set) const;

  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }

 protected:
  Parameters parameters_;
};

}  // namespace kiln
