#include "framework/registry/Registry.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

class Galerkin : public PetrovGalerkin {
 public:
  static Specification specification() { return reduced_specification(); }
  Galerkin(const Teuchos::ParameterList& block, const Context& context)
      : PetrovGalerkin(full_size_parts(context, [] { return std::make_unique<GalerkinTestBasis>(); }),
                       NewtonSettings(context.input.sublist("time").sublist("newton")), factors_of(block)) {}
};

KILN_REGISTER(Method, Galerkin, "galerkin",
              "Galerkin projection on the whole domain: the residual is orthogonal to the basis");

}  // namespace
}  // namespace kiln
