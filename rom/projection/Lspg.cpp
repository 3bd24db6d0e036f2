#include "framework/registry/Registry.hpp"
#include "rom/projection/FullSize.hpp"

namespace kiln {
namespace {

class Lspg : public PetrovGalerkin {
 public:
  static Specification specification() { return reduced_specification(); }
  Lspg(const Teuchos::ParameterList& block, const Context& context)
      : PetrovGalerkin(full_size_parts(context, [] { return std::make_unique<LspgTestBasis>(); }),
                       NewtonSettings(context.input.sublist("time").sublist("newton")), factors_of(block)) {}
};

KILN_REGISTER(Method, Lspg, "lspg", "least-squares Petrov-Galerkin on the whole domain: the residual is minimal");

}  // namespace
}  // namespace kiln
