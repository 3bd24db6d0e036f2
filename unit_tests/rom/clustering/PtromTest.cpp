#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "framework/files/Hdf5.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/files/ClusteredMesh.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/rom/Projections.hpp"

namespace kiln {
namespace {

using test::Case;
using test::largest_difference;
using test::march;
using test::self;
using test::world;

/// The chain as a model that no file restores.
class Unrestored : public test::Chain {
 public:
  Unrestored(const Teuchos::ParameterList& list, const Context& context) : Chain(list, context) {}
};
KILN_REGISTER(Model, Unrestored, "test unrestored chain", "the chain, never from a file; for tests");

Case clustered_case(const std::string& folder) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.tolerance = 1e-10;
  values.iterations = 60;
  values.basis_rank = 8;
  values.residual_rank = 10;
  values.samples = 20;
  values.algorithm = "tsqr";
  values.clustering = "per row";
  return values;
}

std::vector<double> run(const Case& values, const std::string& type,
                        const Teuchos::RCP<const Communicator>& communicator) {
  return march(*method_of(values, type, communicator), values);
}

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

struct Setting {
  const char* scheme;
  int windows;
  int components;
  const char* model = "test chain";
};
void PrintTo(const Setting& s, std::ostream* out) {
  *out << s.model << ", " << s.scheme << ", " << s.windows << " windows, " << s.components << " components";
}
class Chains : public testing::TestWithParam<Setting> {
 protected:
  Case trained() {
    Case values = clustered_case(folder_.path().string());
    values.scheme = GetParam().scheme;
    values.windows = GetParam().windows;
    values.components = GetParam().components;
    values.model = GetParam().model;
    values.clustering = clustering_;
    if (clustering_ == "among samples") values.clusters = 16;
    report_ = train(values, world());
    return values;
  }
  TestFolder folder_;
  RunReport report_;
  std::string clustering_ = "per row";
};

/// PTROM tells the sampled particles, GNAT their sources as well; what is not told is 0.
double difference_where_both_tell(const std::vector<double>& ptrom, std::vector<double> gnat) {
  std::size_t told = 0;
  for (std::size_t i = 0; i < ptrom.size(); ++i) {
    if (ptrom[i] == 0.0) gnat[i] = 0.0;
    told += ptrom[i] == 0.0 ? 0 : 1;
  }
  EXPECT_GE(told, 20u);
  return largest_difference(ptrom, gnat);
}

/// Particles of two components.
ParticleTable read_table(const hdf5::Group& group, int modes) {
  const std::vector<long long> ids = group.integers("ids", {0}).values;
  return ParticleTable::read(group, {ids.begin(), ids.end()}, 2, modes);
}

/// The chain's pairs are linear in their sources: two clusters for four sources give GNAT's answers.
TEST_P(Chains, AreGnatWhereClusteringIsExact) {
  const Case values = trained();
  const std::vector<double> gnat = run(values, "gnat", world()), ptrom = run(values, "ptrom", world());
  EXPECT_LT(difference_where_both_tell(ptrom, gnat), 1e-8);
  EXPECT_GT(*std::max_element(gnat.begin(), gnat.end()), 0.6);
  const nlohmann::json& facts = report_.section("training");
  EXPECT_NEAR(facts["trial_clustered"]["worst_query_error"].get<double>(),
              facts["trial"]["worst_query_error"].get<double>(), 1e-7);
}

/// So is any sum over M of the sampled particles, up to the ridge of the fit.
TEST_P(Chains, AreGnatAmongSamples) {
  clustering_ = "among samples";
  const Case values = trained();
  const std::vector<double> gnat = run(values, "gnat", world()), ptrom = run(values, "ptrom", world());
  EXPECT_LT(difference_where_both_tell(ptrom, gnat), 1e-3);
}

TEST_P(Chains, RestartBitByBit) {
  const Case values = trained();
  const auto scheme_of = [&](Method& method) {
    return Registry<TimeScheme>::create(test::input_of(values).sublist("time").sublist("scheme"),
                                        TimeScheme::Context{method, values.step});
  };
  for (const int stop : {13, 20, 21}) {
    const auto whole = method_of(values, "ptrom", world());
    const std::size_t size = local_size(*whole->coordinates());
    VectorView x("x", size), kept("kept", size);
    auto scheme = scheme_of(*whole);
    whole->initial(x);
    scheme->start(x, 0.0);
    run_time_loop(*whole, *scheme, x, {values.step, 0, stop}, {});
    Kokkos::deep_copy(kept, x);
    const std::string file = folder_ / ("stop" + std::to_string(stop) + ".h5");
    {
      hdf5::File out = hdf5::File::create(file, world());
      hdf5::Group method_group = out.create_group("method"), scheme_group = out.create_group("scheme");
      whole->save(method_group);
      scheme->save(scheme_group);
    }
    run_time_loop(*whole, *scheme, x, {values.step, stop, values.steps}, {});
    const auto again = method_of(values, "ptrom", world());
    auto restarted = scheme_of(*again);
    {
      const hdf5::File in = hdf5::File::read(file, world());
      again->restore(in.group("method"));
      restarted->restore(in.group("scheme"));
    }
    run_time_loop(*again, *restarted, kept, {values.step, stop, values.steps}, {});
    for (std::size_t k = 0; k < size; ++k) EXPECT_EQ(kept(k), x(k)) << "stopped at " << stop << ", coordinate " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Ptrom, Chains,
                         testing::Values(Setting{"backward euler", 0, 1}, Setting{"backward euler", 4, 2},
                                         Setting{"bdf2", 4, 1}, Setting{"rk4", 4, 1}, Setting{"explicit euler", 2, 2},
                                         Setting{"backward euler", 4, 1, "test unrestored chain"}));

TEST(Ptrom, SaysWhatItTouches) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.windows = 4;
  const RunReport report = train(values, world());
  nlohmann::json facts, gnat;
  method_of(values, "ptrom", world())->report(facts);
  method_of(values, "gnat", world())->report(gnat);
  EXPECT_EQ(facts["sampled"], 20);
  EXPECT_EQ(facts["source_clustering"], "per row");
  EXPECT_EQ(facts["gnat_sources"], gnat["sources"]);
  // Four windows of twenty particles with four sources each, but for those near the ends.
  EXPECT_LE(facts["pairs"], 4 * 20 * 2);
  EXPECT_GE(facts["pairs"], 4 * 20 * 2 - 8);
  EXPECT_GT(facts["gnat_pairs"], 4 * 20 * 3);
  EXPECT_EQ(facts["pairs_ratio"].get<double>(), facts["pairs"].get<double>() / facts["gnat_pairs"].get<double>());
  EXPECT_EQ(facts["sources_ratio"].get<double>(), facts["sources"].get<double>() / gnat["sources"].get<double>());
  EXPECT_LE(facts["sources"], 20 + 20 * 2);
  EXPECT_EQ(report.facts()["training"]["clusters"].size(), 4u);
}

/// Clusters, shares and rows of the basis, as one rank finds them.
TEST(Ptrom, HasTheSameClustersOnAnyNumberOfRanks) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.windows = 2;
  values.components = 2;
  Case serial = values;
  serial.folder = folder / ("rank" + std::to_string(world()->getRank()));
  std::filesystem::create_directory(serial.folder);
  train(values, world());
  train(serial, self());
  const hdf5::File together = hdf5::File::read(values.folder + "/reduction.h5", world());
  const hdf5::File single = hdf5::File::read(serial.folder + "/reduction.h5", self());
  for (const char* window : {"0", "1"}) {
    const hdf5::Group a = together.group("windows").group(window).group("clusters"),
                      b = single.group("windows").group(window).group("clusters");
    for (const char* name : {"ids", "rows", "row_offsets", "row_clusters", "member_offsets", "members"}) {
      EXPECT_EQ(a.integers(name).values, b.integers(name).values) << name;
    }
    for (const char* name : {"shares", "positions"}) {
      EXPECT_EQ(a.reals(name).values, b.reals(name).values) << name;
    }
    EXPECT_LT(largest_difference(a.reals("row_weights").values, b.reals("row_weights").values), 1e-10);
    EXPECT_LT(largest_difference(a.reals("modes").values, b.reals("modes").values), 1e-7);
  }
  const std::vector<double> expected = run(serial, "ptrom", self());
  EXPECT_LT(largest_difference(run(values, "ptrom", world()), expected), 1e-9);
  Case shared = serial;
  shared.folder = folder / "rank0";
  EXPECT_LT(largest_difference(run(shared, "ptrom", world()), expected), 1e-9);
}

/// What the file tells of the clusters fits what it tells of the particles.
TEST(Ptrom, KeepsMeansOfItsMembersInTheFile) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.windows = 3;
  values.components = 2;
  train(values, world());
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  EXPECT_TRUE(file.has_attribute("trial_clustered"));
  const ParticleTable particles = read_table(file.group("particles"), 24);
  for (int w = 0; w < 3; ++w) {
    const hdf5::Group group = file.group("windows").group(std::to_string(w)).group("clusters");
    const SourceClusters clusters = read_clusters(group);
    const std::size_t columns = 8 * (w + 1) * 2;
    const ParticleTable table = read_table(group, 8 * (w + 1));
    ASSERT_EQ(table.ids.size(), clusters.clusters());
    for (std::size_t c = 0; c < clusters.clusters(); ++c) {
      EXPECT_EQ(table.ids[c], values.count + static_cast<GlobalIndex>(c));
      for (std::size_t k = 0; k < columns; ++k) {
        double mean = 0.0;
        for (std::size_t m = clusters.member_offsets[c]; m < clusters.member_offsets[c + 1]; ++m) {
          mean += clusters.shares[m] * particles.modes.values[particles.find(clusters.members[m]) * 48 + k];
        }
        EXPECT_NEAR(table.modes.values[c * columns + k], mean, 1e-15);
      }
    }
  }
}

TEST(Ptrom, NeedsClusters) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.clustering = "";
  train(values, world());
  EXPECT_EQ(message([&] { method_of(values, "ptrom", world()); }),
            "method.type: 'ptrom' needs clusters of sources, and " + values.folder +
                "/reduction.h5 has none; expected a file trained with reduction.clustering, such as {type: per row, "
                "clusters: 8}; or 'gnat'");
}

TEST(Ptrom, NamesDamagedClusters) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.model = "test unrestored chain";
  train(values, world());
  {
    hdf5::File file = hdf5::File::modify(values.folder + "/reduction.h5", world());
    hdf5::Group clusters = file.group("windows").group("0").group("clusters");
    hdf5::Group broken = file.create_group("broken");
    for (const char* name : {"rows", "row_offsets", "member_offsets", "members"}) {
      broken.write(name, clusters.integers(name).values);
    }
    for (const char* name : {"shares", "row_weights"}) broken.write(name, clusters.reals(name).values);
    std::vector<long long> numbers = clusters.integers("row_clusters").values;
    numbers[3] = 1000;
    broken.write("row_clusters", numbers);
  }
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  EXPECT_EQ(message([&] {
              read_clusters(file.group("broken"));
            }).rfind(values.folder + "/reduction.h5: /broken/row_clusters: does not fit the clusters", 0),
            0u);
}

TEST(ClusteredTraining, RefusesModelsWithoutPairs) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  values.model = "test rate only";
  values.jacobian = "finite difference";
  values.linear_tolerance = values.tolerance = 1e-6;
  EXPECT_EQ(message([&] { check_training(values, world()); }),
            "reduction.clustering: this model does not tell the pairs that its rate is a sum of; expected a model that "
            "does, such as 'sph heat', or no source clustering");
}

TEST(ClusteredTraining, RefusesSharedClustersOfWeightsThatDependOnTheRow) {
  const TestFolder folder;
  Case values = clustered_case(folder.path().string());
  EXPECT_NO_THROW(check_training(values, world()));
  for (const char* type : {"paper", "robust"}) {
    values.clustering = type;
    const std::string text = message([&] { check_training(values, world()); });
    EXPECT_EQ(text.rfind("reduction.clustering: ", 0), 0u) << text;
    EXPECT_NE(text.find("'per row'"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace kiln
