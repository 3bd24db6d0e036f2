/// Registers a model of a new name and then one of a name that Kiln has.
#include "framework/plugin/Plugin.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/sph/Kernel.hpp"

KILN_PLUGIN();

namespace {

struct FlatKernel : kiln::Kernel {
  static kiln::Specification specification() { return {}; }
  FlatKernel(const Teuchos::ParameterList&, const Context&) {}
  double value(double) const override { return 1.0; }
  double gradient_over_distance(double) const override { return 0.0; }
};

KILN_REGISTER(kiln::Kernel, FlatKernel, "flat", "constant");
KILN_REGISTER(kiln::Kernel, FlatKernel, "cubic spline", "not what it says");

}  // namespace
