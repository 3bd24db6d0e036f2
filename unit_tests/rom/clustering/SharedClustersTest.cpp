#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "Random.hpp"
#include "framework/base/Error.hpp"
#include "rom/clustering/CertifiedClusters.hpp"
#include "rom/clustering/SuperposedModes.hpp"

namespace kiln {
namespace {

constexpr std::size_t count = 120;
constexpr double period = 1.0;

/// Vortices of both signs in two groups. They travel towards each other along one line and through each other half way:
/// in the modes, which tell how far each goes, nothing of that is seen.
struct Crossing {
  Crossing() {
    test::Random random(41);
    motion.components = 2;
    motion.beginning = VectorView("beginning", 2 * count);
    motion.modes = MatrixView("modes", 2 * count, 1);
    motion.states = MatrixView("states", 2 * count, 9);
    double square = 0.0, times = 0.0;
    std::vector<double> travelled(2 * count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      motion.ids.push_back(static_cast<GlobalIndex>(100 + 2 * i));
      const double side = i % 2 == 0 ? -1.0 : 1.0;
      motion.beginning(2 * i) = 5.0 * side + random.between(-1.0, 1.0);
      motion.beginning(2 * i + 1) = random.between(-1.0, 1.0);
      travelled[2 * i] = -10.0 * side;
      square += 100.0;
      strengths.push_back(random.between(0.2, 1.0) * (random.next() < 0.5 ? -1.0 : 1.0));
    }
    for (std::size_t t = 0; t < 9; ++t) {
      const double time = static_cast<double>(t) / 8.0 * period;
      times += time * time;
      for (std::size_t k = 0; k < 2 * count; ++k) motion.states(k, t) = motion.beginning(k) + time * travelled[k];
    }
    for (std::size_t k = 0; k < 2 * count; ++k) motion.modes(k, 0) = travelled[k] / std::sqrt(square);
    motion.singular_values = {std::sqrt(square * times)};
    pairs.offsets = {0};
    for (std::size_t row = 0; row < count; row += 7) {
      pairs.rows.push_back(motion.ids[row]);
      for (std::size_t j = 0; j < count; ++j) {
        if (j == row) continue;
        pairs.sources.push_back(motion.ids[j]);
        pairs.weights.push_back(strengths[j]);
      }
      pairs.offsets.push_back(pairs.sources.size());
    }
  }

  double strength(GlobalIndex id) const { return strengths[motion.place(id)]; }
  double state(GlobalIndex id, std::size_t component, std::size_t moment) const {
    return motion.states(2 * motion.place(id) + component, moment);
  }

  SourceMotion motion;
  PairWeights pairs;
  std::vector<double> strengths;
};

template <class Clustering>
Clustering with(double opening, int leaf) {
  Teuchos::ParameterList list("reduction.clustering");
  list.set("opening", opening).set("leaf", leaf).set("smooth", 0.0).set("weights", "sums");
  return Clustering(list, NoContext{});
}

CertifiedClusters at_most(int clusters, double smooth) {
  Teuchos::ParameterList list("reduction.clustering");
  list.set("clusters", clusters).set("leaf", 1).set("smooth", smooth).set("weights", "sums");
  return CertifiedClusters(list, NoContext{});
}

struct Cluster {
  std::vector<GlobalIndex> members;
  std::vector<double> shares;
  double weight;
};

std::vector<Cluster> clusters_of_row(const SourceClusters& clusters, std::size_t row) {
  std::vector<Cluster> result;
  for (std::size_t k = clusters.row_offsets[row]; k < clusters.row_offsets[row + 1]; ++k) {
    const std::size_t c = clusters.row_clusters[k];
    const auto first = static_cast<std::ptrdiff_t>(clusters.member_offsets[c]);
    const auto last = static_cast<std::ptrdiff_t>(clusters.member_offsets[c + 1]);
    result.push_back({{clusters.members.begin() + first, clusters.members.begin() + last},
                      {clusters.shares.begin() + first, clusters.shares.begin() + last},
                      clusters.row_weights[k]});
  }
  return result;
}

double mean(const Crossing& problem, const Cluster& cluster, std::size_t component, std::size_t moment) {
  double sum = 0.0;
  for (std::size_t m = 0; m < cluster.members.size(); ++m) {
    sum += cluster.shares[m] * problem.state(cluster.members[m], component, moment);
  }
  return sum;
}

/// The largest size/√(distance² + smooth²) of any moment; of one member, 0.
double largest_angle(const Crossing& problem, GlobalIndex row, const Cluster& cluster, double smooth = 0.0) {
  double largest = 0.0;
  for (std::size_t t = 0; t < problem.motion.states.extent(1); ++t) {
    double size = 0.0, square = smooth * smooth;
    for (std::size_t d = 0; d < 2; ++d) {
      double low = 1e300, high = -1e300;
      for (const GlobalIndex id : cluster.members) {
        low = std::min(low, problem.state(id, d, t));
        high = std::max(high, problem.state(id, d, t));
      }
      size = std::max(size, high - low);
      square += std::pow(problem.state(row, d, t) - mean(problem, cluster, d, t), 2);
    }
    largest = std::max(largest, size / std::sqrt(square));
  }
  return largest;
}

/// Σ_c w_c K(x_i, x_c) for a smoothed logarithmic potential at a moment.
double potential(const Crossing& problem, GlobalIndex row, const std::vector<Cluster>& clusters, std::size_t moment) {
  double sum = 0.0;
  for (const Cluster& cluster : clusters) {
    double square = 0.01;
    for (std::size_t d = 0; d < 2; ++d) {
      square += std::pow(problem.state(row, d, moment) - mean(problem, cluster, d, moment), 2);
    }
    sum += 0.5 * cluster.weight * std::log(square);
  }
  return sum;
}

/// Root mean square difference from the sum over all sources, over all rows and moments.
double error(const Crossing& problem, const SourceClusters& clusters) {
  double sum = 0.0;
  std::size_t terms = 0;
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    std::vector<Cluster> all;
    for (const GlobalIndex id : problem.motion.ids) {
      if (id != clusters.rows[row]) all.push_back({{id}, {1.0}, problem.strength(id)});
    }
    const std::vector<Cluster> few = clusters_of_row(clusters, row);
    for (std::size_t t = 0; t < problem.motion.states.extent(1); ++t, ++terms) {
      sum +=
          std::pow(potential(problem, clusters.rows[row], few, t) - potential(problem, clusters.rows[row], all, t), 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(terms));
}

/// Every particle but the row is in exactly one of its clusters, with the weight that is the sum of its members'.
void expect_partition(const Crossing& problem, const SourceClusters& clusters, bool weighted) {
  ASSERT_EQ(clusters.rows, problem.pairs.rows);
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    std::set<GlobalIndex> found;
    for (const Cluster& cluster : clusters_of_row(clusters, row)) {
      double weight = 0.0, magnitude = 0.0;
      for (const GlobalIndex id : cluster.members) {
        EXPECT_TRUE(found.insert(id).second);
        EXPECT_NE(id, clusters.rows[row]);
        weight += problem.strength(id);
        magnitude += std::abs(problem.strength(id));
      }
      EXPECT_NEAR(cluster.weight, weight, 1e-13);
      for (std::size_t m = 0; m < cluster.members.size(); ++m) {
        const double share = weighted ? std::abs(problem.strength(cluster.members[m])) / magnitude
                                      : 1.0 / static_cast<double>(cluster.members.size());
        EXPECT_NEAR(cluster.shares[m], share, 1e-14);
      }
      if (weighted) {
        EXPECT_NEAR(magnitude, std::abs(weight), 1e-13) << "members of both signs";
      }
    }
    EXPECT_EQ(found.size(), count - 1);
  }
}

std::size_t widest(const SourceClusters& clusters) {
  std::size_t most = 0;
  for (std::size_t c = 0; c < clusters.clusters(); ++c) {
    most = std::max(most, clusters.member_offsets[c + 1] - clusters.member_offsets[c]);
  }
  return most;
}

TEST(CertifiedClusters, HoldTheirCriterionAtAllMoments) {
  const Crossing problem;
  for (const double opening : {0.2, 0.5, 0.9}) {
    const SourceClusters clusters = with<CertifiedClusters>(opening, 2).clusters(problem.pairs, problem.motion);
    expect_partition(problem, clusters, true);
    EXPECT_GT(widest(clusters), 1u);
    for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
      for (const Cluster& cluster : clusters_of_row(clusters, row)) {
        EXPECT_LT(largest_angle(problem, clusters.rows[row], cluster), opening);
      }
    }
  }
}

/// Distances count as at least `smooth`: clusters are larger there, and never beyond what that allows.
TEST(CertifiedClusters, CountDistancesAsAtLeastSmooth) {
  const Crossing problem;
  Teuchos::ParameterList list("reduction.clustering");
  list.set("opening", 0.5).set("leaf", 1).set("smooth", 1.0).set("weights", "sums");
  const SourceClusters smooth = CertifiedClusters(list, NoContext{}).clusters(problem.pairs, problem.motion);
  expect_partition(problem, smooth, true);
  double plain = 0.0;
  for (std::size_t row = 0; row < smooth.rows.size(); ++row) {
    for (const Cluster& cluster : clusters_of_row(smooth, row)) {
      EXPECT_LT(largest_angle(problem, smooth.rows[row], cluster, 1.0), 0.5);
      plain = std::max(plain, largest_angle(problem, smooth.rows[row], cluster));
    }
  }
  EXPECT_GT(plain, 0.5);
  EXPECT_LT(smooth.row_clusters.size(),
            with<CertifiedClusters>(0.5, 1).clusters(problem.pairs, problem.motion).row_clusters.size());
}

/// Each row fills its number as far as its next smaller opening allows, whatever that opening is.
TEST(CertifiedClusters, KeepToAGivenNumber) {
  const Crossing problem;
  double last = 1e300;
  for (const int most : {30, 50, 80}) {
    const SourceClusters clusters = at_most(most, 0.0).clusters(problem.pairs, problem.motion);
    expect_partition(problem, clusters, true);
    for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
      const std::size_t found = clusters.row_offsets[row + 1] - clusters.row_offsets[row];
      EXPECT_LE(found, static_cast<std::size_t>(most));
      EXPECT_GT(found, static_cast<std::size_t>(most) / 2);
    }
    const double now = error(problem, clusters);
    EXPECT_LT(now, last);
    last = now;
  }
  const SourceClusters all = at_most(count, 0.0).clusters(problem.pairs, problem.motion);
  EXPECT_EQ(widest(all), 1u);
  try {
    at_most(3, 0.0).clusters(problem.pairs, problem.motion);
    FAIL() << "three clusters are enough";
  } catch (const InputError& refusal) {
    const std::string text = refusal.what();
    EXPECT_EQ(text.rfind("reduction.clustering.clusters: 3 are too few: row ", 0), 0u) << text;
  }
}

/// Groups that cross in time: the modes do not say so, the trajectories do.
TEST(SuperposedModes, TakeClustersThatComeTooNearLater) {
  const Crossing problem;
  constexpr double opening = 0.5;
  const SourceClusters clusters = with<SuperposedModes>(opening, 2).clusters(problem.pairs, problem.motion);
  expect_partition(problem, clusters, false);
  double worst = 0.0;
  std::vector<GlobalIndex> members;
  for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
    for (const Cluster& cluster : clusters_of_row(clusters, row)) {
      const double angle = largest_angle(problem, clusters.rows[row], cluster);
      if (angle > worst) members = cluster.members;
      worst = std::max(worst, angle);
    }
  }
  EXPECT_GT(worst, 2.0);
  EXPECT_GT(members.size(), 4u);
  const SourceClusters certified = with<CertifiedClusters>(opening, 2).clusters(problem.pairs, problem.motion);
  EXPECT_LT(error(problem, certified), 0.3 * error(problem, clusters));
}

/// In cluster space a cell is taken by Barnes' and Hut's criterion, and one is opened that fails it.
TEST(SuperposedModes, OpenCellsByBarnesAndHut) {
  const Crossing problem;
  std::vector<double> places(2 * count);
  for (std::size_t k = 0; k < 2 * count; ++k) places[k] = problem.motion.beginning(k) + problem.motion.modes(k, 0);
  for (const double opening : {0.3, 0.8}) {
    const SourceClusters clusters = with<SuperposedModes>(opening, 3).clusters(problem.pairs, problem.motion);
    for (std::size_t row = 0; row < clusters.rows.size(); ++row) {
      const std::size_t target = problem.motion.place(clusters.rows[row]);
      for (const Cluster& cluster : clusters_of_row(clusters, row)) {
        if (cluster.members.size() == 1) continue;
        double size = 0.0, square = 0.0;
        for (std::size_t d = 0; d < 2; ++d) {
          double low = 1e300, high = -1e300, sum = 0.0;
          for (const GlobalIndex id : cluster.members) {
            const double place = places[2 * problem.motion.place(id) + d];
            low = std::min(low, place);
            high = std::max(high, place);
            sum += place;
          }
          size = std::max(size, high - low);
          square += std::pow(places[2 * target + d] - sum / static_cast<double>(cluster.members.size()), 2);
        }
        // A cell is at least as wide as what it holds.
        EXPECT_LT(size / std::sqrt(square), opening);
      }
    }
  }
}

template <class Clustering>
class Trees : public testing::Test {};
using Kinds = testing::Types<SuperposedModes, CertifiedClusters>;
TYPED_TEST_SUITE(Trees, Kinds);

TYPED_TEST(Trees, AreTheSampledModelWhereNothingIsFarEnough) {
  const Crossing problem;
  for (const int leaf : {1, 5}) {
    const SourceClusters clusters = with<TypeParam>(1e-9, leaf).clusters(problem.pairs, problem.motion);
    EXPECT_EQ(widest(clusters), 1u);
    EXPECT_EQ(clusters.clusters(), count);
    EXPECT_EQ(clusters.row_clusters.size(), problem.pairs.sources.size());
    EXPECT_LT(error(problem, clusters), 1e-13);
  }
}

TYPED_TEST(Trees, ErrFewerTheNearerTheyOpen) {
  const Crossing problem;
  double last = 1e300;
  std::size_t fewer = 0;
  for (const double opening : {0.9, 0.45, 0.22, 0.11}) {
    const SourceClusters clusters = with<TypeParam>(opening, 1).clusters(problem.pairs, problem.motion);
    EXPECT_GT(clusters.row_clusters.size(), fewer);
    fewer = clusters.row_clusters.size();
    const double now = error(problem, clusters);
    EXPECT_LT(now, last);
    last = now;
  }
}

TYPED_TEST(Trees, DoNotSeeRoundOff) {
  const Crossing problem, other;
  test::Random random(5);
  for (std::size_t k = 0; k < 2 * count; ++k) {
    other.motion.modes(k, 0) *= 1.0 + 1e-13 * random.between(-1.0, 1.0);
    for (std::size_t t = 0; t < 9; ++t) other.motion.states(k, t) *= 1.0 + 1e-13 * random.between(-1.0, 1.0);
  }
  const auto clustering = with<TypeParam>(0.5, 2);
  const SourceClusters a = clustering.clusters(problem.pairs, problem.motion),
                       b = clustering.clusters(other.pairs, other.motion);
  EXPECT_EQ(a.row_offsets, b.row_offsets);
  EXPECT_EQ(a.row_clusters, b.row_clusters);
  EXPECT_EQ(a.member_offsets, b.member_offsets);
  EXPECT_EQ(a.members, b.members);
}

/// A particle that is a source of itself stays one by itself; one that is no source at all is in no cluster.
TYPED_TEST(Trees, KeepRowsByThemselves) {
  Crossing problem;
  PairWeights pairs;
  pairs.offsets = {0};
  const std::vector<GlobalIndex> sources(problem.motion.ids.begin() + 3, problem.motion.ids.end());
  for (const std::size_t row : {0, 50}) {
    pairs.rows.push_back(problem.motion.ids[row]);
    for (const GlobalIndex id : sources) {
      pairs.sources.push_back(id);
      pairs.weights.push_back(problem.strength(id));
    }
    pairs.offsets.push_back(pairs.sources.size());
  }
  const SourceClusters clusters = with<TypeParam>(0.8, 4).clusters(pairs, problem.motion);
  for (std::size_t row = 0; row < 2; ++row) {
    std::set<GlobalIndex> found;
    for (const Cluster& cluster : clusters_of_row(clusters, row)) {
      for (const GlobalIndex id : cluster.members) EXPECT_TRUE(found.insert(id).second);
      if (found.count(pairs.rows[row]) > 0 && cluster.members.size() > 1) {
        EXPECT_EQ(std::count(cluster.members.begin(), cluster.members.end(), pairs.rows[row]), 0);
      }
    }
    EXPECT_EQ(found, std::set<GlobalIndex>(sources.begin(), sources.end()));
  }
}

template <class Clustering>
std::string message(const PairWeights& pairs, const SourceMotion& motion) {
  try {
    with<Clustering>(0.5, 1).clusters(pairs, motion);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TYPED_TEST(Trees, RefuseWeightsOfTheRowsOwn) {
  Crossing problem;
  problem.pairs.weights[count + 5] *= 1.5;
  const std::string weights = message<TypeParam>(problem.pairs, problem.motion);
  EXPECT_EQ(weights.rfind("reduction.clustering: source ", 0), 0u) << weights;
  EXPECT_NE(weights.find("'per row'"), std::string::npos) << weights;

  Crossing sparse;
  sparse.pairs.sources.pop_back();
  sparse.pairs.weights.pop_back();
  sparse.pairs.offsets.back() -= 1;
  const std::string missing = message<TypeParam>(sparse.pairs, sparse.motion);
  EXPECT_EQ(missing,
            "reduction.clustering: particle 336 is no source of row 338, as it is of others; expected weights that are "
            "the source's own; for others, source clustering of type 'per row'");
}

}  // namespace
}  // namespace kiln
