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

/// The block of a small part with one line replaced.
Teuchos::ParameterList checked(const std::string& line, const std::string& replacement) {
  return checked_model(
      "model:\n  type: sph heat\n  particles:\n    type: lattice\n    origin: [0 mm, -1 mm, 0 mm]\n"
      "    size: [0.4 mm, 0.2 mm, 0.2 mm]\n    count: [11, 6, 6]\n  material: 316L\n"
      "  initial_temperature: 293.15 K\n  heat_source: none\n",
      line, replacement);
}

std::string message_of(const std::string& line, const std::string& replacement) {
  try {
    checked(line, replacement);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(HeatInput, DefaultsAreThoseOfTheReport) {
  const Teuchos::ParameterList list = checked("none", "none");
  EXPECT_EQ(list.get<double>("smoothing_length"), 1.5);
  EXPECT_EQ(list.sublist("kernel").get<std::string>("type"), "cubic spline");
  EXPECT_EQ(list.get<std::string>("boundary"), "as printed");
  EXPECT_EQ(list.sublist("particles").get<std::string>("placement"), "nodes");
  EXPECT_EQ(list.sublist("table").get<double>("step"), 1.0);
  const auto model = Registry<Model>::create(list, {Tpetra::getDefaultComm()});
  EXPECT_EQ(model->rows()->getGlobalNumElements(), 396u);
}

TEST(HeatInput, MistakesAreCaughtByTheSpecification) {
  expect_in("model.particles.count", message_of("[11, 6, 6]", "[11, -6, 6]"));
  expect_in("1 node along z; expected at least 2", message_of("[11, 6, 6]", "[11, 6, 1]"));
  expect_in("model.particles.size", message_of("0.4 mm", "0 mm"));
  expect_in("model.particles.origin", message_of("-1 mm", ".nan"));
  expect_in("model.initial_temperature", message_of("293.15 K", "-5 K"));
  expect_in("did you mean '316L'?", message_of("316L", "316"));
  expect_in("800 K is not above from = 900 K",
            message_of("heat_source: none", "heat_source: none\n  table: {from: 900, to: 800}"));
}

}  // namespace
}  // namespace kiln
