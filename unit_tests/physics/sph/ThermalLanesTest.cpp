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
TEST(ThermalLanes, AreTheStatesOneByOne) {
  const auto steel = Registry<Material>::create(HeatCase().material, {Tpetra::getDefaultComm()});
  const MaterialTable table(*steel, 200.0, 6000.0, 1.0, "model.material");
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

}  // namespace
}  // namespace kiln
#endif
