#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "Projections.hpp"
#include "framework/files/Hdf5.hpp"
#include "rom/files/ReductionFile.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using test::Case;
using test::largest_difference;
using test::march;
using test::method_of;
using test::self;
using test::train;
using test::world;

/// Diagonal Jacobians keep the full-order run, which is not under test here, free of Krylov iterations.
Case training_case(const std::string& folder) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.iterations = 40;
  return values;
}

std::vector<double> run(const Case& values, const std::string& type,
                        const Teuchos::RCP<const Communicator>& communicator) {
  return march(*method_of(values, type, communicator), values);
}

/// Largest difference over the particles a method holds, as a share of the largest rise.
double error(const std::vector<double>& held, const std::vector<double>& exact) {
  double worst = 0.0, rise = 0.0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] == 0.0) continue;
    worst = std::max(worst, std::abs(held[i] - exact[i]));
    rise = std::max(rise, std::abs(exact[i] - 0.5));
  }
  return worst / rise;
}

class Training : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Components, Training, testing::Values(1, 2));

TEST_P(Training, MakesReducedRunsThatFollowTheFullOrderOne) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.components = GetParam();
  values.tolerance = 1e-8;
  train(values, world());
  const std::vector<double> exact = run(values, "fom", world());
  EXPECT_LT(error(run(values, "galerkin", world()), exact), 5e-3);
  EXPECT_LT(error(run(values, "lspg", world()), exact), 5e-3);
  const std::vector<double> sampled = run(values, "gnat", world());
  EXPECT_LT(error(sampled, exact), 1e-2);
  // The two queried particles are told, the last one among them.
  EXPECT_NE(sampled[29 * values.components], 0.0);
  EXPECT_NE(sampled[59 * values.components], 0.0);
}

TEST_P(Training, IsTheSameOnAnyNumberOfRanks) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.components = GetParam();
  values.tolerance = 1e-10;
  values.basis_rank = 8;
  values.residual_rank = 9;
  values.samples = 16;
  // The small singular values that gram loses to round-off would differ.
  values.algorithm = "tsqr";
  Case serial = values;
  serial.folder = folder / ("rank" + std::to_string(world()->getRank()));
  std::filesystem::create_directory(serial.folder);
  train(values, world());
  train(serial, self());
  for (const char* type : {"galerkin", "lspg", "gnat"}) {
    const std::vector<double> expected = run(serial, type, self());
    EXPECT_LT(largest_difference(run(values, type, world()), expected), 1e-10) << type;
    // A file written on one rank is read on many.
    Case shared = serial;
    shared.folder = folder / "rank0";
    const std::vector<double> on_many = run(shared, type, world());
    EXPECT_LT(largest_difference(on_many, expected), 1e-10) << type;
    // So small a sample mesh is evaluated by every rank alone: as on one, but for round-off in telling the state.
    if (type == std::string("gnat")) {
      EXPECT_LT(largest_difference(on_many, run(shared, type, self())), 1e-14);
    }
  }
}

/// Which particles a full-order run's highest and lowest values stood at.
class Extremal final : public StepListener {
 public:
  explicit Extremal(const Method& method) : method_(method) {}
  void observe(const Moment& moment) override {
    if (moment.step == 0) return;
    const std::vector<double> state = test::gathered_state(method_, moment.x);
    ids.insert(std::min_element(state.begin(), state.end()) - state.begin());
    ids.insert(std::max_element(state.begin(), state.end()) - state.begin());
  }
  std::set<GlobalIndex> ids;

 private:
  const Method& method_;
};

TEST(Training, ReductionsGoOnTellingTheExtremes) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.basis_rank = 4;
  values.residual_rank = 4;
  values.samples = 4;
  train(values, world());
  const auto full = method_of(values, "fom", world());
  Extremal extremal(*full);
  march(*full, values, {&extremal});
  EXPECT_GT(extremal.ids.size(), 1u);
  const auto gnat = method_of(values, "gnat", world());
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  const std::vector<long long> held = file.group("particles").integers("ids").values;
  for (const GlobalIndex id : extremal.ids) {
    EXPECT_TRUE(std::binary_search(held.begin(), held.end(), id)) << id << " is not held";
  }
  EXPECT_LT(gnat->particles()->getGlobalNumElements(), 60u) << "it is told what is not held";
}

TEST(Training, WritesASelfContainedFile) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  RunReport report = train(values, world());
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  EXPECT_EQ(file.text("format"), "kiln reduction");
  EXPECT_EQ(file.text("model_type"), "test chain");
  EXPECT_EQ(file.group("parameters").real("power"), 40.0);
  EXPECT_EQ(file.group("time").real("step"), values.step);
  const hdf5::Group window = file.group("windows").group("0");
  EXPECT_EQ(window.group("basis").shape("modes"), (std::vector<std::size_t>{60, 10}));
  EXPECT_EQ(window.real("end"), values.step * values.steps);
  EXPECT_EQ(file.shape("reference"), (std::vector<std::size_t>{60, 1}));
  EXPECT_EQ(window.group("basis").shape("singular_values"), (std::vector<std::size_t>{40}));
  const hdf5::Group mesh = window.group("sample_mesh");
  EXPECT_EQ(mesh.shape("rows"), (std::vector<std::size_t>{24}));
  EXPECT_EQ(mesh.shape("gappy_operator"), (std::vector<std::size_t>{12, 24}));
  EXPECT_GT(mesh.real("sigma_min"), 0.0);
  const hdf5::Group particles = file.group("particles");
  const Questions questions = Questions::read(particles);
  EXPECT_EQ(questions.particles(), (std::vector<GlobalIndex>{29, 59}));
  EXPECT_NEAR(questions.spacing, 1.0 / values.count, 1e-15);
  // The basis rows at the particles held are those of the full basis.
  const std::vector<long long> held = particles.integers("ids").values;
  const hdf5::Array<double> all = window.group("basis").reals("modes"), some = particles.reals("modes");
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (int k = 0; k < 10; ++k) EXPECT_EQ(some.values[i * 10 + k], all.values[held[i] * 10 + k]);
  }
  const nlohmann::json& facts = report.section("training");
  EXPECT_EQ(facts["stages"].size(), 5u);
  EXPECT_EQ(facts["basis"][0]["rank"], 10);
  EXPECT_EQ(facts["lspg"]["residual_snapshots"], facts["lspg"]["residuals"]);
  EXPECT_EQ(facts["sample_meshes"][0]["sampled"], 24);
}

TEST(Training, TakesTheLastStepWhereSnapshotsAreFartherApartThanTheRunIsLong) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.snapshots_every = std::numeric_limits<int>::max();
  values.basis_rank = 1;
  values.residual_rank = 4;
  values.samples = 8;
  EXPECT_EQ(train(values, world()).section("training")["state_snapshots"], 1);
}

TEST(Training, AllRowsAndACompleteResidualBasisMakeGnatLspg) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.count = 16;
  values.steps = 30;
  values.tolerance = 1e-10;
  values.basis_rank = 5;
  values.residual_rank = 16;
  values.samples = 16;
  values.algorithm = "tsqr";
  train(values, world());
  EXPECT_LT(largest_difference(run(values, "gnat", world()), run(values, "lspg", world())), 1e-8);
}

TEST(Training, ServesExplicitSchemes) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.scheme = "rk4";
  train(values, world());
  const std::vector<double> exact = run(values, "fom", world());
  EXPECT_LT(error(run(values, "galerkin", world()), exact), 1e-2);
  EXPECT_LT(error(run(values, "gnat", world()), exact), 5e-2);
}

TEST(Training, ServesModelsThatOfferTheirRateAlone) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.jacobian = "finite difference";
  values.linear_tolerance = 1e-6;
  values.tolerance = 1e-6;
  values.steps = 20;
  values.basis_rank = 8;
  train(values, world());
  const std::vector<double> sampled = run(values, "gnat", world());
  values.model = "test rate only";
  train(values, world());
  const std::vector<double> masked = run(values, "gnat", world());
  // The masked model's sources are all particles; those of the sampled one agree. Differences of the rate are
  // differences of other vectors, so the Jacobians agree to their accuracy only.
  double difference = 0.0;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    EXPECT_NE(masked[i], 0.0);
    if (sampled[i] != 0.0) difference = std::max(difference, std::abs(masked[i] - sampled[i]));
  }
  EXPECT_LT(difference, 1e-5);
}

TEST(Gnat, HoldsEachSourceAndQueriedParticleOnce) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  train(values, world());
  const auto gnat = method_of(values, "gnat", world());
  EXPECT_TRUE(gnat->particles()->isOneToOne());
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  const hdf5::Group window = file.group("windows").group("0");
  std::vector<long long> ids = window.group("sample_mesh").integers("sources").values;
  for (const GlobalIndex query : Questions::read(file.group("particles")).nearest) ids.push_back(query);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  EXPECT_EQ(gnat->particles()->getGlobalNumElements(), ids.size());
  const ConstPositionView positions = gnat->positions();
  for (std::size_t i = 0; i < positions.extent(0); ++i) {
    const auto id = gnat->particles()->getGlobalElement(static_cast<LocalIndex>(i));
    EXPECT_DOUBLE_EQ(positions(i, 0), (static_cast<double>(id) + 0.5) / values.count);
  }
  nlohmann::json facts;
  gnat->report(facts);
  EXPECT_EQ(facts["sampled"], 24);
  EXPECT_EQ(facts["residual_rank"], 12);
  EXPECT_EQ(facts["basis_rank"], 10);
  EXPECT_EQ(facts["full_order_particles"], 60);
}

TEST(Gnat, TakesNewValuesOfLiveParameters) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  train(values, world());
  Case hotter = values;
  hotter.power = 44.0;
  const std::vector<double> exact = run(hotter, "fom", world());
  EXPECT_LT(error(run(hotter, "gnat", world()), exact), 0.05);
  EXPECT_GT(error(run(values, "gnat", world()), exact), 0.05);
}

}  // namespace
}  // namespace kiln
