#include <gtest/gtest.h>

#include <algorithm>

#include "framework/files/Hdf5.hpp"
#include "framework/model/PointRates.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

constexpr double time = 2e-4;
constexpr GlobalIndex particles = 648;
/// Of the largest value; weights go through a product with a mass and a quotient by it.
constexpr double round_off = 4e-14;

const std::vector<GlobalIndex> rows = {3, 48, 100, 101, 307, 330, 590, 600, 640};

HeatCase constant_case() {
  HeatCase values;
  values.material = HeatCase::constant_material(20.0, 600.0, 7000.0);
  return values;
}

/// Clusters of `size` pairs that follow one another, of each row its own: with no regard to temperatures.
SourceClusters clusters_of(const PairWeights& pairs, std::size_t size) {
  SourceClusters clusters;
  clusters.rows = pairs.rows;
  clusters.row_offsets = clusters.member_offsets = {0};
  for (std::size_t row = 0; row < pairs.rows.size(); ++row) {
    for (std::size_t first = pairs.offsets[row]; first < pairs.offsets[row + 1]; first += size) {
      const std::size_t last = std::min(first + size, pairs.offsets[row + 1]);
      double weight = 0.0;
      for (std::size_t pair = first; pair < last; ++pair) weight += pairs.weights[pair];
      for (std::size_t pair = first; pair < last; ++pair) {
        clusters.members.push_back(pairs.sources[pair]);
        clusters.shares.push_back(pairs.weights[pair] / weight);
      }
      clusters.row_clusters.push_back(clusters.clusters());
      clusters.row_weights.push_back(weight);
      clusters.member_offsets.push_back(clusters.members.size());
    }
    clusters.row_offsets.push_back(clusters.row_clusters.size());
  }
  return clusters;
}

/// One cluster for each source, whatever the number of rows that it serves.
SourceClusters one_member_each(const PairWeights& pairs) {
  SourceClusters clusters;
  clusters.rows = pairs.rows;
  clusters.row_offsets = pairs.offsets;
  clusters.row_weights = pairs.weights;
  clusters.members = pairs.sources;
  std::sort(clusters.members.begin(), clusters.members.end());
  clusters.members.erase(std::unique(clusters.members.begin(), clusters.members.end()), clusters.members.end());
  for (const GlobalIndex id : pairs.sources) {
    const auto place = std::lower_bound(clusters.members.begin(), clusters.members.end(), id);
    clusters.row_clusters.push_back(static_cast<std::size_t>(place - clusters.members.begin()));
  }
  clusters.shares.assign(clusters.members.size(), 1.0);
  for (std::size_t c = 0; c <= clusters.members.size(); ++c) clusters.member_offsets.push_back(c);
  return clusters;
}

/// The mean over a cluster's members of what `value` says of them; of a particle, its own.
template <class Value>
double mean(const SourceClusters& clusters, GlobalIndex id, const Value& value) {
  if (id < particles) return value(id);
  const auto cluster = static_cast<std::size_t>(id - particles);
  double sum = 0.0;
  for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
    sum += clusters.shares[m] * value(clusters.members[m]);
  }
  return sum;
}

double tangent(GlobalIndex id) { return std::cos(0.7 * static_cast<double>(id)); }

struct Evaluated {
  VectorView rate, diagonal;
  MatrixView action;
};

template <class Mean>
Evaluated evaluated(const Model& model, const Mean& mean_of) {
  const std::size_t sources = model.sources()->getNodeNumElements(), count = model.rows()->getNodeNumElements();
  VectorView u("u", sources);
  MatrixView v("v", sources, 1);
  for (std::size_t i = 0; i < sources; ++i) {
    const GlobalIndex id = model.sources()->getGlobalElement(static_cast<LocalIndex>(i));
    u(i) = mean_of(id, rough_temperature);
    v(i, 0) = mean_of(id, tangent);
  }
  Evaluated result{VectorView("f", count), VectorView("diagonal", count), MatrixView("J v", count, 1)};
  model.rate(u, time, result.rate);
  model.rate_jacobian_diagonal(u, time, result.diagonal);
  model.apply_rate_jacobian(u, time, v, result.action);
  return result;
}

Evaluated evaluated(const Model& model, const SourceClusters& clusters) {
  return evaluated(model, [&clusters](GlobalIndex id, const auto& value) { return mean(clusters, id, value); });
}

/// Largest difference of the clustered model's values from those of the whole one, which lives on this rank alone, each
/// relative to the largest of its kind.
double difference(const Model& clustered, const SourceClusters& clusters, const Model& whole) {
  const Evaluated found = evaluated(clustered, clusters), expected = evaluated(whole, clusters);
  double scales[3] = {0.0, 0.0, 0.0}, differences[3] = {0.0, 0.0, 0.0};
  for (const GlobalIndex id : rows) {
    const LocalIndex row = whole.rows()->getLocalElement(id), mine = clustered.rows()->getLocalElement(id);
    const double values[3] = {expected.rate(row), expected.diagonal(row), expected.action(row, 0)};
    for (int k = 0; k < 3; ++k) scales[k] = std::max(scales[k], std::abs(values[k]));
    if (mine < 0) continue;
    const double own[3] = {found.rate(mine), found.diagonal(mine), found.action(mine, 0)};
    for (int k = 0; k < 3; ++k) differences[k] = std::max(differences[k], std::abs(own[k] - values[k]));
  }
  return std::max({differences[0] / scales[0], differences[1] / scales[1], differences[2] / scales[2]});
}

TEST(HeatClusters, PairWeightsAreTheSameOnAnyNumberOfRanks) {
  const PairWeights together = HeatCase().model()->pair_weights({330, 3, 640, 48}),
                    single = HeatCase().model(alone())->pair_weights({3, 48, 330, 640});
  EXPECT_EQ(together.rows, (std::vector<GlobalIndex>{3, 48, 330, 640}));
  EXPECT_EQ(together.offsets, single.offsets);
  EXPECT_EQ(together.sources, single.sources);
  EXPECT_EQ(together.weights, single.weights);
  EXPECT_GT(together.sources.size(), 4u * 20u);
  for (const double weight : together.weights) EXPECT_LT(weight, 0.0);
  EXPECT_THROW(HeatCase().model()->pair_weights({5, 9999}), InputError);
}

TEST(HeatClusters, OfOneMemberEachAreTheSampledModel) {
  const auto model = HeatCase().model();
  const auto whole = HeatCase().model(alone());
  const PairWeights pairs = model->pair_weights(rows);
  for (const SourceClusters& clusters : {clusters_of(pairs, 1), one_member_each(pairs)}) {
    const auto clustered = model->clustered(clusters);
    EXPECT_LT(difference(*clustered, clusters, *whole), round_off);
  }
}

TEST(HeatClusters, HaveTheirRowsFirstThenTheClustersTheyUse) {
  const auto model = HeatCase().model();
  const SourceClusters clusters = clusters_of(model->pair_weights(rows), 9);
  const auto clustered = model->clustered(clusters);
  EXPECT_EQ(clustered->rows()->getGlobalNumElements(), rows.size());
  EXPECT_TRUE(clustered->rows()->isOneToOne());
  const Map& sources = *clustered->sources();
  const std::size_t count = clustered->rows()->getNodeNumElements();
  ASSERT_EQ(clustered->positions().extent(0), sources.getNodeNumElements());
  for (std::size_t i = 0; i < sources.getNodeNumElements(); ++i) {
    const GlobalIndex id = sources.getGlobalElement(static_cast<LocalIndex>(i));
    if (i < count) {
      EXPECT_EQ(clustered->rows()->getGlobalElement(static_cast<LocalIndex>(i)), id);
      continue;
    }
    EXPECT_GE(id, particles);
    EXPECT_LT(id, particles + static_cast<GlobalIndex>(clusters.clusters()));
    if (i > count) {
      EXPECT_LT(sources.getGlobalElement(static_cast<LocalIndex>(i - 1)), id);
    }
    // x fastest: 12 particles in 0.48 mm.
    const double x =
        mean(clusters, id, [](GlobalIndex member) { return static_cast<double>(member % 12) * 0.48e-3 / 11.0; });
    EXPECT_NEAR(clustered->positions()(i, 0), x, 1e-15);
  }
}

/// Each row alone with one other row for its source, whoever lists whom: nothing is taken to act both ways.
TEST(HeatClusters, OfRowsAreTheRowsAndActOneWay) {
  const auto model = HeatCase().model();
  SourceClusters none;
  none.rows = none.members = rows;
  none.shares.assign(rows.size(), 1.0);
  none.row_offsets.assign(rows.size() + 1, 0);
  for (std::size_t c = 0; c <= rows.size(); ++c) none.member_offsets.push_back(c);
  const auto without = model->clustered(none);
  const Evaluated quiet = evaluated(*without, none);
  const std::size_t count = without->rows()->getNodeNumElements();
  EXPECT_EQ(without->sources()->getNodeNumElements(), count);
  for (const auto& [row, source] : {std::pair<std::size_t, std::size_t>{2, 7}, {7, 2}, {8, 0}}) {
    SourceClusters one = none;
    for (std::size_t r = row + 1; r <= rows.size(); ++r) one.row_offsets[r] = 1;
    one.row_clusters = {source};
    one.row_weights = {-1e10};
    const auto clustered = model->clustered(one);
    const Evaluated found = evaluated(*clustered, one);
    for (std::size_t j = 0; j < clustered->sources()->getNodeNumElements(); ++j) {
      EXPECT_LT(clustered->sources()->getGlobalElement(static_cast<LocalIndex>(j)), particles);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool listed = clustered->rows()->getGlobalElement(static_cast<LocalIndex>(i)) == rows[row];
      EXPECT_EQ(found.rate(i) != quiet.rate(i), listed);
      EXPECT_EQ(found.diagonal(i) != quiet.diagonal(i), listed);
    }
  }
}

/// With constant properties a pair's term is linear in its source's temperature; with those of steel it is not.
TEST(HeatClusters, AreExactForConstantProperties) {
  const auto model = constant_case().model();
  const SourceClusters clusters = clusters_of(model->pair_weights(rows), 14);
  EXPECT_LT(difference(*model->clustered(clusters), clusters, *constant_case().model(alone())), round_off);
  const auto steel = HeatCase().model();
  EXPECT_GT(
      difference(*steel->clustered(clusters_of(steel->pair_weights(rows), 14)), clusters, *HeatCase().model(alone())),
      1e-3);
}

TEST(HeatClusters, AreRestoredOnAnyNumberOfRanks) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const auto model = HeatCase().model();
  const SourceClusters clusters = clusters_of(model->pair_weights(rows), 14);
  {
    hdf5::File file = hdf5::File::create(folder / "clusters.h5", everyone);
    hdf5::Group group = file.create_group("model");
    model->clustered(clusters)->save_sample(group);
  }
  Teuchos::ParameterList list = HeatCase().list();
  list.remove("particles");
  const auto unclustered = HeatCase().model(alone());
  const auto expected = unclustered->clustered(clusters);
  const Evaluated wanted = evaluated(*expected, clusters);
  for (const bool together : {true, false}) {
    const auto communicator = together ? everyone : alone();
    const hdf5::File file = hdf5::File::read(folder / "clusters.h5", communicator);
    const auto restored = Registry<Model>::restore(list, {communicator}, file.group("model"));
    const Evaluated found = evaluated(*restored, clusters);
    for (std::size_t i = 0; i < found.rate.extent(0); ++i) {
      const LocalIndex row =
          expected->rows()->getLocalElement(restored->rows()->getGlobalElement(static_cast<LocalIndex>(i)));
      EXPECT_EQ(found.rate(i), wanted.rate(row));
      EXPECT_EQ(found.diagonal(i), wanted.diagonal(row));
      EXPECT_EQ(found.action(i, 0), wanted.action(row, 0));
    }
    EXPECT_EQ(restored->rows()->getGlobalNumElements(), rows.size());
  }
}

TEST(HeatClusters, TakeParametersAlongAndServeManyPoints) {
  const auto model = HeatCase().model();
  model->parameters().set("heat_source.power", 90.0);
  const SourceClusters clusters = clusters_of(model->pair_weights(rows), 14);
  const auto clustered = model->clustered(clusters);
  EXPECT_EQ(clustered->parameters().get("heat_source.power"), 90.0);
  const ParameterPoints points{{"heat_source.power"}, {{30.0}, {60.0}}};
  const std::size_t sources = clustered->sources()->getNodeNumElements(),
                    count = clustered->rows()->getNodeNumElements();
  MatrixView u("u", 2, sources), f("f", 2, count);
  VectorView one("u", sources), rate("f", count);
  for (std::size_t i = 0; i < sources; ++i) {
    one(i) = u(0, i) = u(1, i) =
        mean(clusters, clustered->sources()->getGlobalElement(static_cast<LocalIndex>(i)), rough_temperature);
  }
  clustered->at_points(points)->rates(u, time, {1, 1}, f);
  for (std::size_t point = 0; point < 2; ++point) {
    points.set(point, clustered->parameters());
    clustered->rate(one, time, rate);
    double largest = 0.0;
    for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(rate(i)));
    for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(f(point, i), rate(i), 1e-13 * largest);
  }
}

/// Also where members lie on other ranks than the rows.
TEST(HeatClusters, AreTheSameOnAnyNumberOfRanks) {
  const auto model = HeatCase().model(), whole = HeatCase().model(alone());
  SourceClusters clusters = clusters_of(model->pair_weights(rows), 14);
  for (std::size_t m = 0; m < clusters.members.size(); ++m) clusters.members[m] = static_cast<GlobalIndex>(7 * m % 648);
  const auto together = model->clustered(clusters), single = whole->clustered(clusters);
  const Evaluated found = evaluated(*together, clusters), expected = evaluated(*single, clusters);
  for (std::size_t i = 0; i < found.rate.extent(0); ++i) {
    const auto row = single->rows()->getLocalElement(together->rows()->getGlobalElement(static_cast<LocalIndex>(i)));
    EXPECT_EQ(found.rate(i), expected.rate(row));
  }
}

TEST(HeatClusters, OfUnknownParticlesAreRefused) {
  const auto model = HeatCase().model();
  SourceClusters clusters = clusters_of(model->pair_weights(rows), 14);
  clusters.members[20] = 648;
  try {
    model->clustered(clusters);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 648 is in a cluster, but not in the model"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace kiln
