#include <gtest/gtest.h>

#include "unit_tests/physics/sph/ClosedForm.hpp"

/// Closed forms 1 and 2: conduction alone.
namespace kiln {
namespace {

double cosine_mode_error(int cells, double smoothing_length, double* measured_diffusivity = nullptr) {
  const double thickness = 1e-3;
  const double wave_number = 2.0 * M_PI / thickness;
  const double end = 1.0 / (diffusivity * wave_number * wave_number);
  const auto model = slab(cells, 0.0, thickness, smoothing_length).model(alone());
  VectorView u("u", model->positions().extent(0));
  for (std::size_t i = 0; i < u.extent(0); ++i)
    u(i) = 1000.0 + 100.0 * std::cos(wave_number * model->positions()(i, 2));
  const double first = u(0) - 1000.0;
  u = advanced(*model, u, end);
  if (measured_diffusivity != nullptr) *measured_diffusivity = diffusivity * std::log(first / (u(0) - 1000.0));
  return relative_error(*model, u, 1000.0, [&](double, double, double z) {
    return 1000.0 + 100.0 * std::cos(wave_number * z) * std::exp(-diffusivity * wave_number * wave_number * end);
  });
}

TEST(ClosedForms, CosineModeInASlab) {
  std::vector<double> spacings;
  std::vector<double> errors;
  for (const int cells : {20, 40, 80}) {
    spacings.push_back(1e-3 / cells);
    errors.push_back(cosine_mode_error(cells, 2.0));
  }
  for (const double order :
       printed_orders("cosine mode in a slab, h = 2 spacings (theory: order 2)", spacings, errors)) {
    EXPECT_NEAR(order, 2.0, 0.1);
  }
  EXPECT_LT(errors.back(), 2.5e-3);
}

/// At fixed h / spacing the operator does not tend to the second derivative but to 1.0101 times it (the consistency
/// sum of an endless lattice at h = 1.5 spacings): the diffusivity it converges to is that much larger.
TEST(ClosedForms, CosineModeAtTheReportsSmoothingLength) {
  double measured = 0.0;
  const double error = cosine_mode_error(160, 1.5, &measured);
  std::printf("cosine mode, h = 1.5 spacings, 160 cells: error %.3e, diffusivity %.5f of the material's\n", error,
              measured / diffusivity);
  EXPECT_NEAR(measured / diffusivity, 1.01012, 5e-4);
}

/// Two half-spaces at 500 K and 1500 K that touch at z = 0. The contact temperature stays constant and the particles of
/// each side stay on their side of it. So a conductivity that jumps at a temperature between those of the two particles
/// beside the contact gives each side a material of its own, as long as no particle crosses: that is checked.
double half_spaces_error(double ratio, double cells_in_colder_layer, double smoothing_length, double* contact_error) {
  const double hotter = 25.0;
  const double colder = hotter / ratio;
  const double capacity = 7500.0 * 650.0;
  const double contact =
      (500.0 * std::sqrt(colder) + 1500.0 * std::sqrt(hotter)) / (std::sqrt(colder) + std::sqrt(hotter));
  const double end = 1e-3;
  const double cold_layer = std::sqrt(colder / capacity * end);
  const double hot_layer = std::sqrt(hotter / capacity * end);
  const double spacing = cold_layer / cells_in_colder_layer;
  // Erfc(3.5) = 7e-7 of the jump is cut off on each side.
  const int below = static_cast<int>(std::ceil(7.0 * cold_layer / spacing));
  const int above = static_cast<int>(std::ceil(7.0 * hot_layer / spacing));

  HeatCase heat_case = slab(below + above, -below * spacing, (below + above) * spacing, smoothing_length);
  Teuchos::ParameterList material("model.material");
  material.set("type", std::string("formula"))
      .set("specific_heat", std::string("650"))
      .set("density", std::string("7500"));
  char formula[100];
  const double slope_at_contact = (contact - 500.0) / (std::sqrt(M_PI) * cold_layer);
  const double jump = contact - 0.25 * spacing * slope_at_contact;
  std::snprintf(formula, sizeof formula, "u < %.17g ? %.17g : %.17g", jump, colder, hotter);
  heat_case.material = material.set("conductivity", std::string(formula));
  heat_case.table.set("from", 490.0).set("to", 1510.0).set("step", 0.01);
  const auto model = heat_case.model(alone());
  VectorView u("u", model->positions().extent(0));
  for (std::size_t i = 0; i < u.extent(0); ++i) u(i) = model->positions()(i, 2) < 0.0 ? 500.0 : 1500.0;
  u = advanced(*model, u, end);
  for (int i = 0; i < below + above; ++i) EXPECT_EQ(u(i) < jump, i < below) << "particle " << i << " changed its side";
  // The flux is the same on both sides: the interface temperature of its two particles.
  const double interface = (colder * u(below - 1) + hotter * u(below)) / (colder + hotter);
  *contact_error = std::abs(interface - contact) / 1000.0;
  return relative_error(*model, u, 1000.0, [&](double, double, double z) {
    return z < 0.0 ? contact + (contact - 500.0) * std::erf(z / (2.0 * cold_layer))
                   : contact + (1500.0 - contact) * std::erf(z / (2.0 * hot_layer));
  });
}

struct HalfSpaces {
  double ratio;                     ///< of the conductivities
  std::vector<double> resolutions;  ///< cells in √(αt) of the colder side
  double error;                     ///< bound at the finest of them
};

class HalfSpacesTest : public testing::TestWithParam<HalfSpaces> {};

/// Across the contact the sum is first-order accurate at best. Coarse lattices show more than that while the error is
/// still that of the thin cold layer.
TEST_P(HalfSpacesTest, ContactStaysAndProfilesConverge) {
  const HalfSpaces& half_spaces = GetParam();
  const double cold_layer = std::sqrt(diffusivity / half_spaces.ratio * 1e-3);
  std::vector<double> spacings;
  std::vector<double> errors;
  double contact_error = 0.0;
  for (const double cells : half_spaces.resolutions) {
    spacings.push_back(cold_layer / cells);
    errors.push_back(half_spaces_error(half_spaces.ratio, cells, 2.0, &contact_error));
  }
  char title[100];
  std::snprintf(title, sizeof title, "two half-spaces, conductivities 1 : %g, h = 2 spacings", half_spaces.ratio);
  for (const double order : printed_orders(title, spacings, errors)) EXPECT_GT(order, 0.75);
  std::printf("  contact temperature off by %.1e of the jump\n", contact_error);
  EXPECT_LT(errors.back(), half_spaces.error);
  EXPECT_LT(contact_error, 2.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Ratios, HalfSpacesTest,
                         testing::Values(HalfSpaces{2.0, {2.5, 5.0, 10.0}, 6e-4},
                                         HalfSpaces{10.0, {2.5, 5.0, 10.0}, 1.8e-3},
                                         HalfSpaces{1000.0, {0.5, 1.0, 2.0}, 4e-3}));

}  // namespace
}  // namespace kiln
