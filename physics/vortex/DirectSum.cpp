#include "physics/vortex/VortexSum.hpp"

namespace kiln {
namespace {

/// Every pair.
class DirectSum final : public VortexSum {
 public:
  static Specification specification() { return {}; }
  DirectSum(const Teuchos::ParameterList&, const Context&) {}

  void velocities(const VortexKernel& kernel, const VortexArrays& vortices, const VortexTargets& targets, double factor,
                  double* velocities) override {
    kernel.velocities(vortices, targets.points, targets.count, factor, velocities);
  }
};

KILN_REGISTER(VortexSum, DirectSum, "direct", "every vortex at every particle: O(N²)");

}  // namespace
}  // namespace kiln
