#include "physics/sph/HeatSource.hpp"

#include <string>

#include "framework/base/Loop.hpp"
#include "framework/model/PointRates.hpp"

namespace kiln {
namespace {

class OneAfterTheOther final : public PointFluxes {
 public:
  OneAfterTheOther(const HeatSource& source, std::size_t count, HeatSource::SetPoint set)
      : source_(source), count_(count), set_(std::move(set)) {}

  void flux(double time, ConstPositionView positions, MatrixView q) override {
    if (one_.extent(0) != positions.extent(0)) one_ = VectorView("heat flux of a point", positions.extent(0));
    for (std::size_t point = 0; point < count_; ++point) {
      set_(point);
      source_.flux(time, positions, one_);
      put_point(one_, point, q);
    }
  }

 private:
  const HeatSource& source_;
  std::size_t count_;
  HeatSource::SetPoint set_;
  VectorView one_;
};

class UniformFlux final : public HeatSource {
 public:
  static Specification specification() {
    Specification specification;
    specification.real("flux", "heat flux into the heated surface").unit("W/m^2");
    return specification;
  }
  UniformFlux(const Teuchos::ParameterList& list, const Context&) : flux_(list.get<double>("flux")) {
    parameters_.add("flux", "W/m^2", &flux_);
  }
  void flux(double, ConstPositionView, VectorView q) const override { Kokkos::deep_copy(ExecutionSpace(), q, flux_); }

 private:
  double flux_;
};

/// An insulated surface.
class NoHeatSource final : public HeatSource {
 public:
  static Specification specification() { return {}; }
  NoHeatSource(const Teuchos::ParameterList&, const Context&) {}
  void flux(double, ConstPositionView, VectorView q) const override { Kokkos::deep_copy(ExecutionSpace(), q, 0.0); }
  bool heats() const override { return false; }
};

KILN_REGISTER(HeatSource, UniformFlux, "uniform flux", "the same flux everywhere on the heated surface");
KILN_REGISTER(HeatSource, NoHeatSource, "none", "no heat enters");

}  // namespace

std::unique_ptr<PointFluxes> HeatSource::at_points(std::size_t count, SetPoint set) const {
  return std::make_unique<OneAfterTheOther>(*this, count, std::move(set));
}

}  // namespace kiln
