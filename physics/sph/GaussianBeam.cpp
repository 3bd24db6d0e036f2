#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/Exponential.hpp"
#include "framework/base/Loop.hpp"
#include "framework/base/Pi.hpp"
#include "physics/sph/HeatSource.hpp"

namespace kiln {
namespace {

// Made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string beam_label = "kiln::sph::gaussian beam";

/// Eq. 9: P/(2πσ²) exp(−r²/(2σ²)) with r the distance from start + velocity · t in the x-y plane, which deposits P; or,
/// as the report prints it, exp(−r²/(2πσ²)), which deposits πP.
class GaussianBeam final : public HeatSource {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("power", "absorbed power").unit("W").at_least(0);
    specification.real("width", "standard deviation of the beam").unit("m").above(0);
    specification.reals("start", "x and y of the beam at t = 0").unit("m").length(2);
    specification.reals("velocity", "velocity of the beam along x and y").unit("m/s").length(2);
    specification
        .choice("normalisation",
                "standard: exponent -r^2/(2 width^2), deposits `power`; printed: -r^2/(2 pi width^2) as in Eq. 9, "
                "deposits pi times as much",
                {"standard", "printed"})
        .defaults_to("standard");
    return specification;
  }

  GaussianBeam(const Teuchos::ParameterList& list, const Context&)
      : power_(list.get<double>("power")),
        width_(list.get<double>("width")),
        printed_(list.get<std::string>("normalisation") == "printed") {
    const auto start = list.get<Teuchos::Array<double>>("start");
    const auto velocity = list.get<Teuchos::Array<double>>("velocity");
    for (int axis = 0; axis < 2; ++axis) {
      start_[axis] = start[axis];
      velocity_[axis] = velocity[axis];
    }
    parameters_.add("power", "W", &power_, Allowed::not_negative);
    parameters_.add("width", "m", &width_, Allowed::positive);
    parameters_.add("velocity.x", "m/s", &velocity_[0]);
    parameters_.add("velocity.y", "m/s", &velocity_[1]);
    parameters_.add("start.x", "m", &start_[0]);
    parameters_.add("start.y", "m", &start_[1]);
  }

  void flux(double time, ConstPositionView positions, VectorView q) const override {
    const Shape beam = shape();
    const double peak = beam.peak, exponent = beam.exponent;
    const double x = start_[0] + velocity_[0] * time;
    const double y = start_[1] + velocity_[1] * time;
    const auto places = borrowed(positions);
    const auto flux = borrowed(q);
    const auto number = static_cast<LocalIndex>(positions.extent(0));
#ifdef KILN_LANES
    const auto at = [=](const double* eight) {
      const FirstTwoLanes place = first_two_of_triples(eight);
      const Lanes dx = place.first - x, dy = place.second - y;
      return peak * decayed(-exponent * (dx * dx + dy * dy));
    };
    loop(
        beam_label, (number + lane_count - 1) / lane_count, KOKKOS_LAMBDA(LocalIndex group) {
          const LocalIndex first = group * lane_count;
          if (number - first >= lane_count) return store_lanes(&flux(first), at(&places(first, 0)));
          // Through the lanes, too: a particle's flux does not depend on who is beside it.
          double eight[3 * lane_count] = {}, values[lane_count];
          for (LocalIndex k = 0; k < 3 * (number - first); ++k) eight[k] = places.data()[3 * first + k];
          store_lanes(values, at(eight));
          for (LocalIndex i = first; i < number; ++i) flux(i) = values[i - first];
        });
#else
    loop(
        beam_label, number, KOKKOS_LAMBDA(LocalIndex i) {
          const double dx = places(i, 0) - x;
          const double dy = places(i, 1) - y;
          flux(i) = peak * exp(exponent * (dx * dx + dy * dy));
        });
#endif
  }

#ifdef KILN_LANES
  std::unique_ptr<PointFluxes> at_points(std::size_t count, SetPoint set) const override;
#endif

 private:
  class AtPoints;

  struct Shape {
    double peak;      ///< q in the middle, in W/m²
    double exponent;  ///< factor of r², in 1/m²
  };
  Shape shape() const {
    return {power_ / (2.0 * pi * width_ * width_), -1.0 / (2.0 * (printed_ ? pi : 1.0) * width_ * width_)};
  }

  double power_;
  double width_;
  double start_[2];
  double velocity_[2];
  bool printed_;
};

#ifdef KILN_LANES
/// Eight points' beams are the lanes of vectors.
class GaussianBeam::AtPoints final : public PointFluxes {
 public:
  AtPoints(const GaussianBeam& beam, std::size_t count, const SetPoint& set) : count_(count) {
    eights_.resize((count + lane_count - 1) / lane_count);
    for (std::size_t lane = 0; lane < eights_.size() * lane_count; ++lane) {
      // Lanes without a point are the last one's.
      set(std::min(lane, count - 1));
      const auto [peak, exponent] = beam.shape();
      const double values[] = {peak, exponent, beam.start_[0], beam.start_[1], beam.velocity_[0], beam.velocity_[1]};
      for (int k = 0; k < 6; ++k) eights_[lane / lane_count].values[k][lane % lane_count] = values[k];
    }
  }

  void flux(double time, ConstPositionView positions, MatrixView q) override {
    const auto number = static_cast<LocalIndex>(positions.extent(0));
    const auto places = borrowed(positions);
    const auto fluxes = borrowed(q);
    for (std::size_t eight = 0; eight < eights_.size(); ++eight) {
      const auto& [peak, exponent, start_x, start_y, velocity_x, velocity_y] = eights_[eight].values;
      const Lanes middle_x = start_x + velocity_x * time, middle_y = start_y + velocity_y * time;
      const std::size_t first = eight * lane_count, points = std::min<std::size_t>(lane_count, count_ - first);
      for (LocalIndex i = 0; i < number; ++i) {
        const Lanes dx = places(i, 0) - middle_x, dy = places(i, 1) - middle_y;
        const Lanes flux = peak * decayed(-exponent * (dx * dx + dy * dy));
        if (points == lane_count) {
          store_lanes(&fluxes(first, i), flux);
        } else {
          for (std::size_t lane = 0; lane < points; ++lane) fluxes(first + lane, i) = flux[lane];
        }
      }
    }
  }

 private:
  struct Eight {
    Lanes values[6];  ///< peak, exponent, start and velocity
  };
  std::size_t count_;
  std::vector<Eight> eights_;
};

std::unique_ptr<PointFluxes> GaussianBeam::at_points(std::size_t count, SetPoint set) const {
  return std::make_unique<AtPoints>(*this, count, set);
}
#endif

KILN_REGISTER(HeatSource, GaussianBeam, "gaussian beam", "moving Gaussian beam (Eq. 9)");

}  // namespace
}  // namespace kiln
