#include "rom/clustering/PerRow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "Random.hpp"

namespace kiln {
namespace {

/// Particles 10, 13, 16, …, their states at five moments, and rows with some of the others as sources.
struct Problem {
  explicit Problem(int components, bool one_sign) {
    test::Random random(23);
    motion.components = components;
    for (GlobalIndex k = 0; k < 60; ++k) motion.ids.push_back(10 + 3 * k);
    motion.states = MatrixView("states", 60 * components, 5);
    for (std::size_t i = 0; i < motion.states.extent(0); ++i) {
      for (std::size_t t = 0; t < 5; ++t) motion.states(i, t) = random.between(0.0, 10.0);
    }
    pairs.offsets.push_back(0);
    for (const std::size_t row : {4, 17, 41}) {
      pairs.rows.push_back(motion.ids[row]);
      for (std::size_t k = 0; k < 60; ++k) {
        if (random.next() < 0.3) continue;
        pairs.sources.push_back(motion.ids[k]);
        const double weight = random.between(0.1, 3.0);
        pairs.weights.push_back(one_sign || k % 3 != 0 ? -weight : weight);
      }
      pairs.offsets.push_back(pairs.sources.size());
    }
  }
  SourceMotion motion;
  PairWeights pairs;
};

PerRow per_row(int clusters) {
  Teuchos::ParameterList list("reduction.clustering");
  return PerRow(list.set("clusters", clusters).set("weights", std::string("sums")), NoContext{});
}

class PerRowSums : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Components, PerRowSums, testing::Values(1, 2));

/// Each source of a row is in one of the row's clusters, and Σ_c w_c u_c = Σ_j w_j u_j for any u.
TEST_P(PerRowSums, AreKeptExactly) {
  for (const bool one_sign : {true, false}) {
    const Problem problem(GetParam(), one_sign);
    const SourceClusters found = per_row(9).clusters(problem.pairs, problem.motion);
    EXPECT_EQ(found.rows, problem.pairs.rows);
    const auto any = [](GlobalIndex id) { return std::sin(1.7 * static_cast<double>(id)); };
    for (std::size_t row = 0; row < 3; ++row) {
      std::map<GlobalIndex, double> weights;
      double exact = 0.0, sum = 0.0;
      for (std::size_t pair = problem.pairs.offsets[row]; pair < problem.pairs.offsets[row + 1]; ++pair) {
        exact += problem.pairs.weights[pair] * any(problem.pairs.sources[pair]);
      }
      const bool itself = std::count(problem.pairs.sources.begin() + problem.pairs.offsets[row],
                                     problem.pairs.sources.begin() + problem.pairs.offsets[row + 1], found.rows[row]);
      EXPECT_EQ(found.row_offsets[row + 1] - found.row_offsets[row], itself ? 10u : 9u);
      for (std::size_t k = found.row_offsets[row]; k < found.row_offsets[row + 1]; ++k) {
        const std::size_t cluster = found.row_clusters[k];
        double shares = 0.0, state = 0.0;
        for (std::size_t m = found.member_offsets[cluster]; m < found.member_offsets[cluster + 1]; ++m) {
          EXPECT_TRUE(weights.emplace(found.members[m], found.shares[m] * found.row_weights[k]).second);
          EXPECT_GT(found.shares[m], 0.0);
          if (found.members[m] == found.rows[row]) {
            EXPECT_EQ(found.member_offsets[cluster + 1] - found.member_offsets[cluster], 1u);
          }
          shares += found.shares[m];
          state += found.shares[m] * any(found.members[m]);
        }
        EXPECT_NEAR(shares, 1.0, 1e-14);
        sum += found.row_weights[k] * state;
      }
      EXPECT_NEAR(sum, exact, 1e-13);
      for (std::size_t pair = problem.pairs.offsets[row]; pair < problem.pairs.offsets[row + 1]; ++pair) {
        EXPECT_NEAR(weights.at(problem.pairs.sources[pair]), problem.pairs.weights[pair], 1e-14);
      }
      EXPECT_EQ(weights.size(), problem.pairs.offsets[row + 1] - problem.pairs.offsets[row]);
    }
  }
}

TEST(PerRow, HasClustersOfOneWhereThereAreEnough) {
  const Problem problem(1, true);
  const SourceClusters found = per_row(60).clusters(problem.pairs, problem.motion);
  EXPECT_EQ(found.clusters(), problem.pairs.sources.size());
  EXPECT_EQ(found.shares, std::vector<double>(found.clusters(), 1.0));
}

/// Two kinds of trajectories that are the same at the beginning and at the end.
TEST(PerRow, LooksAtAllMoments) {
  SourceMotion motion;
  motion.components = 1;
  motion.states = MatrixView("states", 9, 3);
  PairWeights pairs;
  pairs.rows = {0};
  for (GlobalIndex id = 0; id < 9; ++id) {
    motion.ids.push_back(id);
    motion.states(id, 0) = motion.states(id, 2) = 300.0 + 1e-3 * static_cast<double>(id);
    motion.states(id, 1) = id % 2 == 0 ? 400.0 : 900.0;
    if (id == 0) continue;
    pairs.sources.push_back(id);
    pairs.weights.push_back(-1.0);
  }
  pairs.offsets = {0, 8};
  const SourceClusters found = per_row(2).clusters(pairs, motion);
  EXPECT_EQ(found.members, (std::vector<GlobalIndex>{1, 3, 5, 7, 2, 4, 6, 8}));
  EXPECT_EQ(found.member_offsets, (std::vector<std::size_t>{0, 4, 8}));
}

}  // namespace
}  // namespace kiln
