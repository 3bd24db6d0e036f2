#include "physics/sph/Material.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <fstream>

#include "framework/registry/Registry.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

std::unique_ptr<Material> material(const Teuchos::ParameterList& list) {
  return Registry<Material>::create(list, {Tpetra::getDefaultComm()});
}

Teuchos::ParameterList formula(const std::string& conductivity) {
  Teuchos::ParameterList list("model.material");
  list.set("type", std::string("formula")).set("conductivity", conductivity);
  return list.set("specific_heat", std::string("458.984 + 0.1328*u")).set("density", std::string("7000 - 0.5*u"));
}

MaterialTable steel() { return {*material(HeatCase().material), 200.0, 6000.0, 1.0, "model.material"}; }

TEST(Material, SteelInItsThreePhases) {
  const auto at = [table = steel()](double u) { return table.at(u); };
  EXPECT_NEAR(at(300.0).conductivity, 13.961, 1e-12);
  EXPECT_NEAR(at(300.0).specific_heat, 498.824, 1e-12);
  EXPECT_NEAR(at(300.0).density, 7954.42522, 1e-9);
  EXPECT_NEAR(at(2000.0).conductivity, 18.968, 1e-12);
  EXPECT_NEAR(at(2000.0).specific_heat, 769.855, 1e-12);
  EXPECT_NEAR(at(2000.0).density, 6791.096, 1e-9);
  EXPECT_NEAR(at(4000.0).conductivity, 21.6465, 1e-12);
  EXPECT_NEAR(at(4000.0).density, 6124.72, 1e-12);
}

TEST(MaterialTable, InterpolatesAndIsClamped) {
  const MaterialTable table = steel();
  EXPECT_NEAR(table.at(300.25).density, 0.75 * table.at(300.0).density + 0.25 * table.at(301.0).density, 1e-9);
  EXPECT_EQ(table.at(10.0).conductivity, table.at(200.0).conductivity);
  EXPECT_EQ(table.at(9999.0).conductivity, 21.6465);
  EXPECT_EQ(table.slopes(10.0).conductivity, 0.0);
  EXPECT_EQ(table.slopes(9999.0).density, 0.0);
  EXPECT_EQ(table.at(std::nan("")).conductivity, 21.6465);
}

TEST(MaterialTable, SlopesAreDerivatives) {
  const MaterialTable table = steel();
  // The jump at 1660.5 K lies between two entries and is as steep as they are close.
  for (const double u : {250.3, 1200.7, 1660.4, 2500.2, 3089.5, 5000.5}) {
    const MaterialPoint<double> slope = table.slopes(u);
    const MaterialPoint<std::complex<double>> step = table.at(std::complex<double>(u, 1e-30));
    EXPECT_NEAR(slope.conductivity, step.conductivity.imag() * 1e30, 1e-12 + 1e-12 * std::abs(slope.conductivity));
    EXPECT_NEAR(slope.specific_heat, step.specific_heat.imag() * 1e30, 1e-12 + 1e-12 * std::abs(slope.specific_heat));
    EXPECT_NEAR(slope.density, step.density.imag() * 1e30, 1e-11 + 1e-12 * std::abs(slope.density));
  }
  EXPECT_LT(table.slopes(1660.4).density, -100.0);
}

TEST(MaterialTable, OfFormulasIsFewPieces) {
  const MaterialTable table = steel();
  ASSERT_NE(table.pieces(), nullptr);
  // Solid, the jump at 1660.5 K, liquid, the jump at 3090 K, vapour, the end.
  EXPECT_EQ(table.pieces()->starts[1], 1460.0);
  EXPECT_TRUE(std::isfinite(table.pieces()->starts[5]));
  EXPECT_TRUE(std::isinf(table.pieces()->starts[6]));
  // Between its rows the straight line, not the curve that they lie on: a row apart, they differ by 1e-5 kg/m^3.
  const std::vector<double> rows = table.values();
  for (double u = 200.3; u < 6000.0; u += 0.7) {
    const auto i = static_cast<std::size_t>(u - 200.0);
    const double f = u - 200.0 - static_cast<double>(i);
    const MaterialPoint<double> point = table.at(u);
    const double found[] = {point.conductivity, point.specific_heat, point.density};
    for (std::size_t k = 0; k < 3; ++k) {
      const double expected = (1.0 - f) * rows[3 * i + k] + f * rows[3 * i + 3 + k];
      ASSERT_NEAR(found[k], expected, 1e-14 * expected) << u << " K";
    }
  }
}

TEST(MaterialTable, OfAnyOtherLawKeepsItsRows) {
  const auto cubic = material(formula("10 + 1e-8*u*u*u"));
  const MaterialTable table(*cubic, 200.0, 1200.0, 1.0, "model.material");
  EXPECT_EQ(table.pieces(), nullptr);
  const std::vector<double> rows = table.values();
  EXPECT_DOUBLE_EQ(table.at(700.25).conductivity, 0.75 * rows[3 * 500] + 0.25 * rows[3 * 501]);
}

TEST(MaterialTable, SurvivesItsValues) {
  const MaterialTable table = steel();
  const MaterialTable copy(table.from(), table.step(), table.values());
  for (const double u : {150.0, 777.7, 6100.0}) EXPECT_EQ(copy.at(u).density, table.at(u).density);
}

TEST(Material, FormulaKnowsConditions) {
  const auto steps = material(formula("u < 1000 ? 10 + 0.01*u : 30"));
  EXPECT_DOUBLE_EQ(steps->at(500.0).conductivity, 15.0);
  EXPECT_DOUBLE_EQ(steps->at(1500.0).conductivity, 30.0);
}

TEST(Material, WrongFormulaIsNamed) {
  try {
    material(formula("10 + 0.01*v"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("model.material.conductivity: '10 + 0.01*v'"), std::string::npos);
  }
}

TEST(Material, PropertyThatIsNotPositiveIsNamedWithItsTemperature) {
  try {
    MaterialTable(*material(formula("1000 - u")), 900.0, 1100.0, 1.0, "model.material");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("model.material: the conductivity at 1000 K is 0"), std::string::npos);
  }
}

TEST(Material, TableFromCsv) {
  const TestFolder folder;
  const auto from = [&folder](const std::string& content) {
    std::ofstream(folder / "material.csv") << content;
    return material(Teuchos::ParameterList("model.material")
                        .set("type", std::string("table"))
                        .set("path", folder / "material.csv"));
  };
  const std::string header = "temperature,conductivity,specific heat,density\n";
  const auto table = from(header + "300,10,500,8000\n400,20,600,7000\n");
  EXPECT_DOUBLE_EQ(table->at(325.0).conductivity, 12.5);
  EXPECT_DOUBLE_EQ(table->at(325.0).density, 7750.0);
  EXPECT_DOUBLE_EQ(table->at(100.0).specific_heat, 500.0);
  EXPECT_DOUBLE_EQ(table->at(500.0).specific_heat, 600.0);
  try {
    from(header + "300,10,500,8000\n300,20,600,7000\n");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("line 3: temperature 300 follows 300; expected rising"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace kiln
