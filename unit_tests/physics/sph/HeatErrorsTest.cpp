#include <gtest/gtest.h>

#include <limits>

#include "framework/base/Error.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string message(const HeatCase& heat_case) {
  try {
    heat_case.model();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

std::string message(const ParticleCloud& cloud, bool mirrored = false) {
  const auto kernel =
      Registry<Kernel>::create(Teuchos::ParameterList("kernel").set("type", std::string("cubic spline")), {1.5});
  try {
    whole_domain(cloud, {*kernel, 3.0, mirrored, 8000.0, "model"}, Tpetra::getDefaultComm());
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

ParticleCloud row_of_particles() {
  ParticleCloud cloud;
  for (int i = 0; i < 40; ++i) cloud.positions.push_back({1.0 * i, 0.0, 0.0});
  cloud.volumes.assign(40, 1.0);
  cloud.heated_areas.assign(40, 0.0);
  cloud.spacing = 1.0;
  return cloud;
}

void expect_in(const std::string& text, const std::string& whole) {
  EXPECT_NE(whole.find(text), std::string::npos) << whole;
}

TEST(HeatErrors, CoincidentParticles) {
  ParticleCloud cloud = row_of_particles();
  EXPECT_EQ(message(cloud), "nothing was thrown");
  cloud.positions[33] = cloud.positions[7];
  expect_in("model.particles: particles 7 and 33 coincide at (7, 0, 0) m", message(cloud));
}

TEST(HeatErrors, IsolatedParticle) {
  ParticleCloud cloud = row_of_particles();
  cloud.positions[12] = {12.0, 50.0, 1.5};
  expect_in("model.particles: particle 12 at (12, 50, 1.5) m has no neighbour; expected at least one", message(cloud));
}

TEST(HeatErrors, PositionThatIsNotFinite) {
  ParticleCloud cloud = row_of_particles();
  cloud.positions[5][1] = infinity;
  expect_in("model.particles: particle 5 lies at (5, inf, 0) m", message(cloud));
  HeatCase heat_case;
  heat_case.origin[2] = std::nan("");
  expect_in("model.particles.origin: z is nan", message(heat_case));
}

TEST(HeatErrors, NoParticles) { expect_in("there is no particle", message(ParticleCloud())); }

TEST(HeatErrors, MirroringWantsCells) {
  expect_in("model.boundary: mirrored boundaries need cells", message(row_of_particles(), true));
  HeatCase heat_case;
  heat_case.boundary = "mirrored";
  expect_in("model.boundary: mirrored boundaries need cells", message(heat_case));
}

TEST(HeatErrors, CountsOfParticles) {
  HeatCase heat_case;
  heat_case.count = {12, -9, 6};
  expect_in("model.particles.count: -9 particles along y", message(heat_case));
  heat_case.count = {12, 9, 1};
  expect_in("model.particles.count: 1 particles along z; expected at least 2", message(heat_case));
}

TEST(HeatErrors, TableWithoutRange) {
  HeatCase heat_case;
  heat_case.table.set("from", 800.0).set("to", 700.0);
  expect_in("the table of properties goes from 800 K to 700 K", message(heat_case));
}

TEST(HeatErrors, UnknownComponentIsNamedWithTheNearestOne) {
  HeatCase heat_case;
  heat_case.kernel = "cubic splines";
  expect_in("model.kernel.type: there is no kernel 'cubic splines'", message(heat_case));
  expect_in("did you mean 'cubic spline'?", message(heat_case));
}

TEST(HeatErrors, ArraysOfTheWrongLength) {
  const auto model = HeatCase().model();
  VectorView f("f", model->rows()->getNodeNumElements());
  EXPECT_THROW(model->rate(VectorView("u", 3), 0.0, f), std::invalid_argument);
}

}  // namespace
}  // namespace kiln
