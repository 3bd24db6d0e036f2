#include <fmt/format.h>

#include <Teuchos_Array.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "framework/base/Error.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/vortex/GaussianPatches.hpp"

namespace kiln {
namespace {

/// Patches one by one.
class Patches final : public Vortices {
 public:
  static Specification specification() {
    Specification patch;
    patch.reals("centre", "x and y").unit("m").length(2);
    patch.real("radius", "a of the vorticity Γ/(πa²) exp(−r²/a²)").unit("m").above(0);
    patch.real("circulation", "Γ, counter-clockwise above 0").unit("m^2/s");
    Specification specification;
    specification.sections("patches", "the patches", std::move(patch));
    PatchGrid::add_entries(specification);

    return specification;
  }

  Patches(const Teuchos::ParameterList& list, const Context&) : grid_(list) {
    const Teuchos::ParameterList& patches = list.sublist("patches");
    for (int i = 0; patches.isSublist(std::to_string(i)); ++i) {
      const Teuchos::ParameterList& patch = patches.sublist(std::to_string(i));
      const auto centre = patch.get<Teuchos::Array<double>>("centre");
      patches_.push_back({centre[0], centre[1], patch.get<double>("radius"), patch.get<double>("circulation")});
    }
  }

  VortexCloud cloud() const override { return grid_.cloud(patches_); }

 private:
  PatchGrid grid_;
  std::vector<GaussianPatch> patches_;
};

/// Patches drawn at random. The generator and what becomes of its bits are those of the C++ standard, the same on every
/// machine.
class RandomPatches final : public Vortices {
 public:
  static Specification specification() {
    Specification specification;
    specification.integer("number", "of patches").at_least(1).at_most(1000);
    specification.integer("seed", "another one draws other patches").at_least(0).defaults_to(1);
    specification.reals("size", "width and height of the box around the origin in which the centres lie")
        .unit("m")
        .length(2)
        .at_least(0);
    specification.reals("radius", "least and largest radius").unit("m").length(2).above(0);
    specification.reals("circulation", "least and largest circulation; across 0, patches turn either way")
        .unit("m^2/s")
        .length(2);
    PatchGrid::add_entries(specification);
    specification.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
      for (const char* range : {"radius", "circulation"}) {
        const auto& ends = list.get<Teuchos::Array<double>>(range);
        if (ends[0] <= ends[1]) continue;
        problems.push_back({range, fmt::format("the least, {:g}, is above the largest, {:g}", ends[0], ends[1]),
                            "the least first", ""});
      }
    });
    return specification;
  }

  RandomPatches(const Teuchos::ParameterList& list, const Context&) : grid_(list) {
    const auto size = list.get<Teuchos::Array<double>>("size");
    const auto radius = list.get<Teuchos::Array<double>>("radius");
    const auto circulation = list.get<Teuchos::Array<double>>("circulation");
    std::mt19937_64 generator(static_cast<std::uint64_t>(list.get<int>("seed")));
    // The standard leaves open how its distributions use the generator.
    const auto between = [&generator](double lower, double upper) {
      return lower + (upper - lower) * std::ldexp(static_cast<double>(generator() >> 11), -53);
    };
    for (int i = 0; i < list.get<int>("number"); ++i) {
      GaussianPatch patch{};
      patch.x = between(-0.5 * size[0], 0.5 * size[0]);
      patch.y = between(-0.5 * size[1], 0.5 * size[1]);
      patch.radius = between(radius[0], radius[1]);
      patch.circulation = between(circulation[0], circulation[1]);
      patches_.push_back(patch);
    }
  }

  VortexCloud cloud() const override { return grid_.cloud(patches_); }

 private:
  PatchGrid grid_;
  std::vector<GaussianPatch> patches_;
};

KILN_REGISTER(Vortices, Patches, "patches", "vortices of Gaussian vorticity, as particles on a regular grid");
KILN_REGISTER(Vortices, RandomPatches, "random patches", "vortices of Gaussian vorticity at random places");

}  // namespace
}  // namespace kiln
