#include "physics/sph/ThermalLanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "framework/registry/Registry.hpp"
#include "physics/sph/Material.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

#ifdef KILN_LANES
namespace kiln {
namespace {

/// To the last bit: which particles of a rank go eight at a time depends on the number of ranks.
void expect_states_one_by_one(const Teuchos::ParameterList& material, bool in_pieces) {
  const auto created = Registry<Material>::create(material, {Tpetra::getDefaultComm()});
  const MaterialTable table(*created, 200.0, 6000.0, 1.0, "model.material");
  ASSERT_EQ(table.pieces() != nullptr, in_pieces);
  std::vector<double> temperatures = {10.0,   200.0,        5999.5, 6000.0,
                                      9999.0, std::nan(""), 1660.7, std::numeric_limits<double>::infinity()};
  for (int k = 0; k < 400; ++k) temperatures.push_back(150.0 + 14.77 * k);
  for (std::size_t first = 0; first < temperatures.size(); first += lane_count) {
    double masses[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) masses[lane] = 1e-10 * (1.0 + 0.1 * lane);
    ThermalState<double> stored[lane_count];
    store_states(stored, thermal_lanes(table, lanes_at(&temperatures[first]), lanes_at(masses)));
    for (int lane = 0; lane < lane_count; ++lane) {
      const double u = temperatures[first + lane];
      const ThermalState<double> expected = thermal_state(table, u, masses[lane]);
      EXPECT_EQ(std::memcmp(&stored[lane], &expected, sizeof expected), 0) << u << " K";
    }
  }
}

TEST(ThermalLanes, AreTheStatesOneByOne) { expect_states_one_by_one(HeatCase().material, true); }

TEST(ThermalLanes, OfATableOfRowsAreTheStatesOneByOne) {
  Teuchos::ParameterList list("model.material");
  list.set("type", std::string("formula")).set("conductivity", std::string("10 + 1e-10*u*u*u"));
  list.set("specific_heat", std::string("458.984 + 0.1328*u")).set("density", std::string("8000 - 0.5*u"));
  expect_states_one_by_one(list, false);
}

}  // namespace
}  // namespace kiln
#endif
