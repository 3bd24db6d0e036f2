#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/Error.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

constexpr const char* nothing = "nothing was thrown";

std::string message(const VortexCase& vortex_case) {
  try {
    vortex_case.model();
  } catch (const InputError& error) {
    return error.what();
  }
  return nothing;
}

void expect_in(const std::string& text, const std::string& whole) {
  EXPECT_NE(whole.find(text), std::string::npos) << whole;
}

TEST(VortexErrors, NoParticle) {
  EXPECT_EQ(message(VortexCase()), nothing);
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::two_patches(50.0);
  expect_in("model.particles: there is no particle; expected at least 1", message(vortex_case));
}

TEST(VortexErrors, GridThatIsTooFine) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::two_patches(1e-9);
  expect_in("model.particles.spacing: a grid of spacing 1e-09 m around the patches is too fine; expected at most",
            message(vortex_case));
}

TEST(VortexErrors, ValuesThatAreNotFinite) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::pair(1.0, std::nan(""), 1.0);
  expect_in("model.particles: particle 1 has the circulation nan m^2/s", message(vortex_case));
  vortex_case.particles = VortexCase::pair(1.0, 1.0, INFINITY);
  expect_in("model.particles: particle 0 lies at (-inf, 0) m", message(vortex_case));
  vortex_case.particles = VortexCase::two_patches(0.3);
  vortex_case.particles.sublist("patches").sublist("1").set("radius", std::nan(""));
  expect_in("model.particles.patches: a patch at (0.9, -0.2) m has the radius nan m", message(vortex_case));
}

TEST(VortexErrors, CoreRadiusThatIsSetToNothing) {
  const auto model = VortexCase().model();
  for (const double radius : {0.0, -0.1}) {
    try {
      model->parameters().set("kernel.core_radius", radius);
      ADD_FAILURE() << nothing;
    } catch (const InputError& error) {
      expect_in("parameter 'kernel.core_radius' is set to", error.what());
      expect_in("expected a finite number in m above 0", error.what());
    }
  }
}

TEST(VortexErrors, UnknownKernelIsNamedWithTheNearestOne) {
  VortexCase vortex_case;
  vortex_case.kernel = "lamb-osen";
  expect_in("did you mean 'lamb-oseen'?", message(vortex_case));
}

/// The block of a YAML file through the checker, with one line replaced.
std::string checked(const std::string& line, const std::string& replacement) {
  const std::string text =
      "model:\n"
      "  type: vortex\n"
      "  particles:\n"
      "    type: patches\n"
      "    patches: [{centre: [0 m, 1 m], radius: 0.5 m, circulation: 2 m^2/s}]\n"
      "    spacing: 0.2 m\n"
      "  kernel: {type: rosenhead-moore, core_radius: 0.1 m}\n";
  try {
    const auto model = Registry<Model>::create(checked_model(text, line, replacement), {Tpetra::getDefaultComm()});
    return model->rows()->getGlobalNumElements() > 100 ? nothing : "few particles";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(VortexInput, MistakesAreCaughtByTheSpecification) {
  EXPECT_EQ(checked("0.2 m", "0.2 m"), nothing);
  expect_in("model.kernel.core_radius: '-0.1 m' is not above 0", checked("core_radius: 0.1 m", "core_radius: -0.1 m"));
  expect_in("model.kernel.core_radius", checked("core_radius: 0.1 m", "core_radius: .nan"));
  expect_in("model.particles.patches: an empty list is given; expected a list of blocks",
            checked("[{centre: [0 m, 1 m], radius: 0.5 m, circulation: 2 m^2/s}]", "[]"));
  expect_in("model.particles.spacing: is missing, and so is count; expected either",
            checked("    spacing: 0.2 m\n", ""));
  expect_in("model.particles.spacing: stands beside count",
            checked("spacing: 0.2 m", "spacing: 0.2 m\n    count: 100"));
  expect_in("radius", checked("radius: 0.5 m", "radius: 0 m"));
  expect_in("did you mean 'rosenhead-moore'?", checked("rosenhead-moore", "rosenhead moore"));
  expect_in("model.sum.opening", checked("0.1 m}\n", "0.1 m}\n  sum: {type: barnes-hut, opening: -0.5}\n"));
  expect_in("model.sum.leaf", checked("0.1 m}\n", "0.1 m}\n  sum: {type: barnes-hut, leaf: 0}\n"));
  expect_in("0, and there are 2 rows",
            checked("type: patches\n    patches: [{centre: [0 m, 1 m], radius: 0.5 m, circulation: 2 m^2/s}]\n    "
                    "spacing: 0.2 m\n",
                    "type: shear layer\n    length: 1 m\n    count: 5\n    rows: 2\n    velocity_jump: 1 m/s\n"));
}

}  // namespace
}  // namespace kiln
