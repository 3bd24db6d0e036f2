#include "physics/vortex/VortexKernel.hpp"

#include "physics/vortex/VortexKernelOf.hpp"

namespace kiln {
namespace {

KILN_REGISTER(VortexKernel, CoreKernel<RosenheadMooreLaw>, "rosenhead-moore", "r⊥/(2π(r² + δ²)): algebraic core");
KILN_REGISTER(VortexKernel, CoreKernel<LambOseenLaw>, "lamb-oseen",
              "r⊥/(2πr²) (1 − exp(−r²/δ²)): Gaussian core of radius δ");

}  // namespace
}  // namespace kiln
