#include "framework/base/Pi.hpp"
#include "physics/vortex/Vortices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numeric>

#include "framework/base/Error.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

VortexCloud cloud_of(const Teuchos::ParameterList& list) {
  return Registry<Vortices>::create(list, {Tpetra::getDefaultComm()})->cloud();
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Teuchos::ParameterList one_patch() {
  Teuchos::ParameterList list = VortexCase::block("patches");
  Teuchos::ParameterList& patches = list.sublist("patches").setName("model.particles.patches");
  patches.sublist("0").set("centre", reals({0.3, -0.7})).set("radius", 0.5).set("circulation", 1.7);
  return list.set("cutoff", 3.0);
}

TEST(Patches, AreAGaussianOnARegularGrid) {
  const double h = 0.1;
  const VortexCloud cloud = cloud_of(one_patch().set("spacing", h).set("cutoff", 5.0));
  EXPECT_NEAR(sum(cloud.circulation), 1.7, 1e-9) << "the rule of equal cells is exact for smooth vorticity";
  EXPECT_NEAR(static_cast<double>(cloud.x.size()), pi * 2.5 * 2.5 / (h * h), 60.0);
  double second_moment = 0.0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const double column = cloud.x[i] / h - 0.5, row = cloud.y[i] / h - 0.5;
    EXPECT_NEAR(column, std::round(column), 1e-9);
    EXPECT_NEAR(row, std::round(row), 1e-9);
    const double r2 = std::pow(cloud.x[i] - 0.3, 2) + std::pow(cloud.y[i] + 0.7, 2);
    EXPECT_LE(r2, 2.5 * 2.5 * (1.0 + 1e-12));
    EXPECT_NEAR(cloud.circulation[i], 1.7 / (pi * 0.25) * std::exp(-r2 / 0.25) * h * h, 1e-16);
    second_moment += cloud.circulation[i] * r2;
    if (i > 0) {
      EXPECT_TRUE(cloud.y[i] > cloud.y[i - 1] || (cloud.y[i] == cloud.y[i - 1] && cloud.x[i] > cloud.x[i - 1]));
    }
  }
  EXPECT_NEAR(second_moment, 1.7 * 0.25, 1e-7);
}

TEST(Patches, CountFindsItsSpacing) {
  for (const int count : {1, 50, 1000, 3000}) {
    const std::size_t found = cloud_of(one_patch().set("count", count)).x.size();
    EXPECT_GE(found, static_cast<std::size_t>(count));
    // A grid gains its particles a few at a time, by its symmetry.
    EXPECT_LE(found, static_cast<std::size_t>(count) + 8);
  }
}

Teuchos::ParameterList random_patches(int seed) {
  Teuchos::ParameterList list = VortexCase::block("random patches");
  list.set("number", 6).set("seed", seed).set("size", reals({4.0, 2.0})).set("radius", reals({0.2, 0.4}));
  return list.set("circulation", reals({-1.0, 2.0})).set("spacing", 0.1).set("cutoff", 3.0);
}

TEST(RandomPatches, ComeFromTheirSeedAlone) {
  const VortexCloud first = cloud_of(random_patches(3)), again = cloud_of(random_patches(3));
  EXPECT_EQ(first.x, again.x);
  EXPECT_EQ(first.y, again.y);
  EXPECT_EQ(first.circulation, again.circulation);
  EXPECT_NE(first.x, cloud_of(random_patches(4)).x);
  for (std::size_t i = 0; i < first.x.size(); ++i) {
    EXPECT_LE(std::abs(first.x[i]), 2.0 + 1.2);
    EXPECT_LE(std::abs(first.y[i]), 1.0 + 1.2);
  }
  EXPECT_LT(*std::min_element(first.circulation.begin(), first.circulation.end()), 0.0);
  EXPECT_GT(*std::max_element(first.circulation.begin(), first.circulation.end()), 0.0);
  // Of the generator's standard: the 10,000th number is fixed, and so are these on every machine.
  const VortexCloud one = cloud_of(random_patches(1).set("number", 1));
  const double centre =
      std::inner_product(one.x.begin(), one.x.end(), one.circulation.begin(), 0.0) / sum(one.circulation);
  EXPECT_NEAR(centre, -2.0 + 4.0 * std::ldexp(2469588189546311528.0, -64), 2e-3);
}

TEST(ShearLayer, MovesTheFluidAboveAndBelow) {
  Teuchos::ParameterList list = VortexCase::block("shear layer");
  list.set("length", 8.0).set("count", 100).set("rows", 3).set("thickness", 0.3).set("velocity_jump", 2.0);
  list.set("amplitude", 0.1).set("waves", 2.0);
  const VortexCloud cloud = cloud_of(list);
  ASSERT_EQ(cloud.x.size(), 300u);
  EXPECT_NEAR(sum(cloud.circulation), -16.0, 1e-12);
  EXPECT_NEAR(sum(cloud.x), 0.0, 1e-11);
  EXPECT_NEAR(sum(cloud.y), 0.0, 1e-11);
  EXPECT_NEAR(cloud.x[1] - cloud.x[0], 0.08, 1e-14);
  EXPECT_NEAR(cloud.y[112] - cloud.y[12], 0.1, 1e-14);
  EXPECT_NEAR(cloud.y[112], 0.1 * std::sin(4.0 * pi * 0.125), 1e-14);
  // Velocity at the layer's middle from far above: towards +x.
  double u = 0.0;
  for (std::size_t j = 0; j < cloud.x.size(); ++j) {
    const double dx = -cloud.x[j], dy = 0.4 - cloud.y[j];
    u -= cloud.circulation[j] * dy / (2.0 * pi * (dx * dx + dy * dy));
  }
  EXPECT_NEAR(u, 1.0, 0.1);
}

TEST(VortexFile, GivesItsRows) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const auto write = [&](const std::string& content) {
    if (everyone->getRank() == 0) std::ofstream(folder / "vortices.csv") << content;
    everyone->barrier();
    return VortexCase::block("file").set("path", folder / "vortices.csv");
  };
  const VortexCloud cloud = cloud_of(write("# two\ncirculation, x, y\n 2.5, -1, 0.5\n-1e-3, 4, 0\n"));
  EXPECT_EQ(cloud.x, (std::vector<double>{-1.0, 4.0}));
  EXPECT_EQ(cloud.y, (std::vector<double>{0.5, 0.0}));
  EXPECT_EQ(cloud.circulation, (std::vector<double>{2.5, -1e-3}));
  const auto message = [&](const std::string& content) -> std::string {
    everyone->barrier();
    try {
      cloud_of(write(content));
    } catch (const FileError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_NE(message("x,y,circulation\n0,0,1\n1,nan,1\n").find("line 3, column 'y': 'nan' is not a finite number"),
            std::string::npos);
  EXPECT_NE(message("x,y\n0,0\n").find("column 'circulation' is missing"), std::string::npos);
  EXPECT_NE(message("x,y,z,circulation\n0,0,0,1\n").find("column 'z' is not known"), std::string::npos);
  EXPECT_NE(message("x,y,circulation\n").find("has no line of numbers"), std::string::npos);
}

}  // namespace
}  // namespace kiln
