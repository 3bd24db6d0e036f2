#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "framework/files/Hdf5.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/time/TimeLoop.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"
#include "unit_tests/rom/Projections.hpp"

namespace kiln {
namespace {

using test::Case;
using test::self;
using test::world;

/// A part of 648 particles, melted by a beam of 40 W; the reduction is that of a test::Case.
Case settings(const std::string& folder, int clusters) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.tolerance = 1e-8;
  values.iterations = 40;
  values.refresh = 5;
  values.step = 10e-6;
  values.steps = 30;
  values.basis_rank = 8;
  values.residual_rank = 12;
  values.samples = 24;
  values.algorithm = "tsqr";
  values.windows = 2;
  values.clustering = "per row";
  values.clusters = clusters;
  return values;
}

Teuchos::ParameterList input_of(const Case& values, const HeatCase& heat) {
  Teuchos::ParameterList input = test::input_of(values);
  input.remove("model");
  input.set("model", heat.list());
  return input;
}

RunReport train(const Case& values, const HeatCase& heat, const Teuchos::RCP<const Communicator>& communicator) {
  const Teuchos::ParameterList input = input_of(values, heat);
  RunReport report;
  Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, communicator, true})
      ->train(values.folder + "/reduction.h5", report);
  return report;
}

/// The coordinates at the end.
std::vector<double> run(Case values, const HeatCase& heat, const std::string& type,
                        const Teuchos::RCP<const Communicator>& communicator) {
  values.method = type;
  const Teuchos::ParameterList input = input_of(values, heat);
  const auto method = Registry<Method>::create(input.sublist("method"), Method::Context{input, communicator});
  const auto scheme =
      Registry<TimeScheme>::create(input.sublist("time").sublist("scheme"), TimeScheme::Context{*method, values.step});
  VectorView x("x", local_size(*method->coordinates()));
  method->initial(x);
  scheme->start(x, 0.0);
  run_time_loop(*method, *scheme, x, {values.step, 0, values.steps}, {});
  return {x.data(), x.data() + x.extent(0)};
}

/// The basis is orthonormal: the states' difference over all particles, relative to the rise.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0.0, scale = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    square += (a[k] - b[k]) * (a[k] - b[k]);
    scale += b[k] * b[k];
  }
  return std::sqrt(square / scale);
}

TEST(HeatPtrom, IsGnatForConstantProperties) {
  const TestFolder folder;
  HeatCase heat;
  heat.material = HeatCase::constant_material(25.0, 650.0, 7500.0);
  const Case values = settings(folder.path().string(), 8);
  train(values, heat, world());
  EXPECT_LT(difference(run(values, heat, "ptrom", world()), run(values, heat, "gnat", world())), 1e-9);
}

TEST(HeatPtrom, ErrsLessTheMoreClustersThereAre) {
  const TestFolder folder;
  const HeatCase heat;
  std::vector<double> errors, ratios;
  for (const int clusters : {4, 8, 16, 32, 200}) {
    const Case values = settings(folder.path().string(), clusters);
    const RunReport report = train(values, heat, world());
    errors.push_back(difference(run(values, heat, "ptrom", world()), run(values, heat, "gnat", world())));
    double pairs = 0.0, all = 0.0;
    for (const nlohmann::json& window : report.facts()["training"]["clusters"]) {
      pairs += window["pairs"].get<double>();
      all += window["unclustered_pairs"].get<double>();
    }
    ratios.push_back(pairs / all);
  }
  for (std::size_t k = 1; k < errors.size(); ++k) {
    EXPECT_LT(errors[k], errors[k - 1]) << k;
    EXPECT_GT(ratios[k], ratios[k - 1]) << k;
  }
  EXPECT_LT(errors[1], 5e-3);
  EXPECT_LT(errors[3], 0.1 * errors[0]);
  // One member each: GNAT to round-off.
  EXPECT_LT(errors.back(), 1e-10);
  EXPECT_EQ(ratios.back(), 1.0);
}

/// Fitted weights take away what curvature does at all moments alike. At another power, which nothing was fitted to,
/// they must not do harm.
TEST(HeatPtrom, ErrsLessWithFittedWeights) {
  const TestFolder folder;
  const HeatCase heat;
  HeatCase hotter;
  hotter.heat_source = HeatCase::beam(44.0);
  double errors[2], hotter_errors[2];
  for (const int fitted : {0, 1}) {
    Case values = settings(folder.path().string(), 8);
    values.cluster_weights = fitted == 1 ? "fitted" : "sums";
    train(values, heat, world());
    errors[fitted] = difference(run(values, heat, "ptrom", world()), run(values, heat, "gnat", world()));
    hotter_errors[fitted] = difference(run(values, hotter, "ptrom", world()), run(values, hotter, "gnat", world()));
  }
  EXPECT_LT(errors[1], 0.5 * errors[0]);
  EXPECT_LT(hotter_errors[1], 1.5 * hotter_errors[0]);
}

/// Few of the other sampled particles tell each one's sum, and no further particle is looked at. At another power,
/// which nothing was fitted to, they must do no harm beside what GNAT misses there itself.
TEST(HeatPtrom, DoesWithTheSampledParticlesAlone) {
  const TestFolder folder;
  const HeatCase heat;
  HeatCase hotter;
  hotter.heat_source = HeatCase::beam(44.0);
  std::vector<double> errors;
  for (const int sources : {2, 4, 16}) {
    Case values = settings(folder.path().string(), sources);
    values.clustering = "among samples";
    train(values, heat, world());
    errors.push_back(difference(run(values, heat, "ptrom", world()), run(values, heat, "gnat", world())));
    values.method = "ptrom";
    const Teuchos::ParameterList input = input_of(values, heat);
    nlohmann::json facts;
    Registry<Method>::create(input.sublist("method"), Method::Context{input, world()})->report(facts);
    EXPECT_EQ(facts["sources"], values.samples);
    EXPECT_EQ(facts["pairs"], 2 * values.samples * sources);
    if (sources < 16) continue;
    EXPECT_LT(difference(run(values, hotter, "ptrom", world()), run(values, hotter, "gnat", world())), 5e-3);
  }
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_LT(errors[2], errors[1]);
  EXPECT_LT(errors[2], 1e-3);
}

class HeatClusterings : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(HeatPtrom, HeatClusterings, testing::Values("per row", "among samples"));

TEST_P(HeatClusterings, AreTheSameOnAnyNumberOfRanks) {
  const TestFolder folder;
  const HeatCase heat;
  Case values = settings(folder.path().string(), 12);
  values.clustering = GetParam();
  Case serial = values;
  serial.folder = folder / ("rank" + std::to_string(world()->getRank()));
  std::filesystem::create_directory(serial.folder);
  train(values, heat, world());
  train(serial, heat, self());
  const hdf5::File together = hdf5::File::read(values.folder + "/reduction.h5", world());
  const hdf5::File single = hdf5::File::read(serial.folder + "/reduction.h5", self());
  for (const char* window : {"0", "1"}) {
    const hdf5::Group a = together.group("windows").group(window), b = single.group("windows").group(window);
    EXPECT_EQ(a.group("sample_mesh").integers("rows").values, b.group("sample_mesh").integers("rows").values);
    for (const char* name : {"rows", "row_offsets", "row_clusters", "member_offsets", "members"}) {
      EXPECT_EQ(a.group("clusters").integers(name).values, b.group("clusters").integers(name).values) << name;
    }
  }
  EXPECT_LT(difference(run(values, heat, "ptrom", world()), run(serial, heat, "ptrom", self())), 1e-8);
}

}  // namespace
}  // namespace kiln
