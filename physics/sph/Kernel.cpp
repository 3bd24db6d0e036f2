#include "physics/sph/Kernel.hpp"

#include <cmath>

#include "framework/base/Pi.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

/// Eq. 8.
class CubicSpline final : public Kernel {
 public:
  static Specification specification() { return {}; }
  CubicSpline(const Teuchos::ParameterList&, const Context& context)
      : h_(context.smoothing_length), scale_(1.0 / (pi * std::pow(h_, 3))) {}

  double value(double r) const override {
    const double s = r / h_;
    if (s >= 2.0) return 0.0;
    return scale_ * (s <= 1.0 ? 1.0 + s * s * (0.75 * s - 1.5) : 0.25 * std::pow(2.0 - s, 3));
  }

  double gradient_over_distance(double r) const override {
    const double s = r / h_;
    if (s >= 2.0) return 0.0;
    return scale_ / (h_ * h_) * (s <= 1.0 ? 2.25 * s - 3.0 : -0.75 * (2.0 - s) * (2.0 - s) / s);
  }

 private:
  double h_;
  double scale_;
};

/// H. Wendland, Advances in Computational Mathematics 4 (1995) 389: 21/(16 π h³) (1 − s/2)⁴ (2s + 1).
class WendlandC2 final : public Kernel {
 public:
  static Specification specification() { return {}; }
  WendlandC2(const Teuchos::ParameterList&, const Context& context)
      : h_(context.smoothing_length), scale_(21.0 / (16.0 * pi * std::pow(h_, 3))) {}

  double value(double r) const override {
    const double s = r / h_;
    return s >= 2.0 ? 0.0 : scale_ * std::pow(1.0 - 0.5 * s, 4) * (2.0 * s + 1.0);
  }

  double gradient_over_distance(double r) const override {
    const double s = r / h_;
    return s >= 2.0 ? 0.0 : -5.0 * scale_ / (h_ * h_) * std::pow(1.0 - 0.5 * s, 3);
  }

 private:
  double h_;
  double scale_;
};

KILN_REGISTER(Kernel, CubicSpline, "cubic spline", "cubic B-spline, support 2h (Eq. 8)");
KILN_REGISTER(Kernel, WendlandC2, "wendland c2", "Wendland's C2 function, support 2h");

}  // namespace
}  // namespace kiln
