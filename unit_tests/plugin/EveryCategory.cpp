/// A component of every category, each the same as one of Kiln's own: a run with these gives the bits of a run with
/// those.
#include <memory>

#include "framework/method/FullOrder.hpp"
#include "framework/observers/Extremes.hpp"
#include "framework/plugin/Plugin.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/solvers/Krylov.hpp"
#include "framework/time/LinearMultistep.hpp"
#include "physics/sph/HeatModel.hpp"
#include "physics/sph/HeatSource.hpp"
#include "physics/sph/Kernel.hpp"
#include "physics/sph/Material.hpp"
#include "physics/sph/Particles.hpp"
#include "physics/vortex/VortexKernelOf.hpp"
#include "physics/vortex/VortexSum.hpp"
#include "physics/vortex/Vortices.hpp"
#include "rom/clustering/PerRow.hpp"
#include "rom/sampling/Greedy.hpp"
#include "rom/training/ProcedureTwo.hpp"

KILN_PLUGIN();

namespace kiln {
namespace {

/// The built-in component `type` of a category, from this block's other keys.
template <class Base>
std::unique_ptr<Base> built_in(const char* type, Teuchos::ParameterList list, const typename Base::Context& context) {
  list.set("type", std::string(type));
  return Registry<Base>::create(list, context);
}

class PluginKernel : public Kernel {
 public:
  static Specification specification() { return {}; }
  PluginKernel(const Teuchos::ParameterList& list, const Context& context)
      : kernel_(built_in<Kernel>("cubic spline", list, context)) {}
  double value(double r) const override { return kernel_->value(r); }
  double gradient_over_distance(double r) const override { return kernel_->gradient_over_distance(r); }

 private:
  std::unique_ptr<Kernel> kernel_;
};

class PluginMaterial : public Material {
 public:
  static Specification specification() { return {}; }
  PluginMaterial(const Teuchos::ParameterList& list, const Context& context)
      : material_(built_in<Material>("316L", list, context)) {}
  MaterialPoint<double> at(double u) const override { return material_->at(u); }

 private:
  std::unique_ptr<Material> material_;
};

class PluginParticles : public Particles {
 public:
  static Specification specification() { return catalogue::find("particles", "lattice", "").specification(); }
  PluginParticles(const Teuchos::ParameterList& list, const Context& context)
      : particles_(built_in<Particles>("lattice", list, context)) {}
  ParticleCloud cloud() const override { return particles_->cloud(); }

 private:
  std::unique_ptr<Particles> particles_;
};

class PluginHeatSource : public HeatSource {
 public:
  static Specification specification() {
    Specification s;
    s.real("flux", "heat flux into the heated surface").unit("W/m^2");
    return s;
  }
  PluginHeatSource(const Teuchos::ParameterList& list, const Context&) : flux_(list.get<double>("flux")) {
    parameters_.add("flux", "W/m^2", &flux_);
  }
  void flux(double, ConstPositionView, VectorView q) const override { Kokkos::deep_copy(ExecutionSpace(), q, flux_); }

 private:
  double flux_;
};

class PluginVortices : public Vortices {
 public:
  static Specification specification() { return catalogue::find("vortices", "patches", "").specification(); }
  PluginVortices(const Teuchos::ParameterList& list, const Context& context)
      : vortices_(built_in<Vortices>("patches", list, context)) {}
  VortexCloud cloud() const override { return vortices_->cloud(); }

 private:
  std::unique_ptr<Vortices> vortices_;
};

class PluginVortexSum : public VortexSum {
 public:
  static Specification specification() { return catalogue::find("vortex sum", "barnes-hut", "").specification(); }
  PluginVortexSum(const Teuchos::ParameterList& list, const Context& context)
      : sum_(built_in<VortexSum>("barnes-hut", list, context)) {}
  void velocities(const VortexKernel& kernel, const VortexArrays& vortices, const VortexTargets& targets, double factor,
                  double* velocities) override {
    sum_->velocities(kernel, vortices, targets, factor, velocities);
  }

 private:
  std::unique_ptr<VortexSum> sum_;
};

/// A law of its own, for which the sums are compiled here.
class PluginLaw : public RosenheadMooreLaw {
 public:
  using RosenheadMooreLaw::RosenheadMooreLaw;
};

struct PluginScheme : LinearMultistep {
  static Specification specification() { return {}; }
  PluginScheme(const Teuchos::ParameterList&, const Context& context)
      : LinearMultistep(MultistepCoefficients::backward_euler(), context) {}
};

KILN_REGISTER(Model, HeatModel, "plugin model", "as 'sph heat'");
KILN_REGISTER(Kernel, PluginKernel, "plugin kernel", "as 'cubic spline'");
KILN_REGISTER(Material, PluginMaterial, "plugin material", "as '316L'");
KILN_REGISTER(Particles, PluginParticles, "plugin particles", "as 'lattice'");
KILN_REGISTER(HeatSource, PluginHeatSource, "plugin heat source", "as 'uniform flux'");
KILN_REGISTER(Vortices, PluginVortices, "plugin vortices", "as 'patches'");
KILN_REGISTER(VortexKernel, CoreKernel<PluginLaw>, "plugin vortex kernel", "as 'rosenhead-moore'");
KILN_REGISTER(VortexSum, PluginVortexSum, "plugin vortex sum", "as 'barnes-hut'");
KILN_REGISTER(TimeScheme, PluginScheme, "plugin scheme", "as 'backward euler'");
KILN_REGISTER(LinearSolver, Gmres, "plugin solver", "as 'gmres'");
KILN_REGISTER(Method, FullOrder, "plugin method", "as 'fom'");
KILN_REGISTER(Observer, Extremes, "plugin observer", "as 'extremes'");
KILN_REGISTER(Sampling, Greedy, "plugin sampling", "as 'greedy'");
KILN_REGISTER(SourceClustering, PerRow, "plugin clustering", "as 'per row'");
KILN_REGISTER(Trainer, ProcedureTwo, "plugin trainer", "as 'procedure ii'");

}  // namespace
}  // namespace kiln
