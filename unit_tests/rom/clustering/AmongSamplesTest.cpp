#include "rom/clustering/AmongSamples.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>

#include "framework/base/Error.hpp"
#include "rom/training/LearnClusters.hpp"
#include "unit_tests/rom/Chain.hpp"

namespace kiln {
namespace {

AmongSamples among_samples() {
  Teuchos::ParameterList list("reduction.clustering");
  return AmongSamples(list.set("sources", 16).set("ridge", 0.005), NoContext{});
}

TEST(AmongSamples, OffersEachRowTheOthers) {
  PairWeights pairs;
  pairs.rows = {5, 8, 30};
  pairs.sources = {6, 8, 100, 30};
  pairs.weights = {-2.0, 1.0, 3.0, 0.5};
  pairs.offsets = {0, 2, 2, 4};
  const SourceClusters offered = among_samples().clusters(pairs, {});
  EXPECT_EQ(offered.rows, pairs.rows);
  EXPECT_EQ(offered.members, pairs.rows);
  EXPECT_EQ(offered.member_offsets, (std::vector<std::size_t>{0, 1, 2, 3}));
  // A row without pairs keeps none.
  EXPECT_EQ(offered.row_offsets, (std::vector<std::size_t>{0, 2, 2, 4}));
  EXPECT_EQ(offered.row_clusters, (std::vector<std::size_t>{1, 2, 0, 1}));
  EXPECT_EQ(offered.row_weights, (std::vector<double>{3.0, 3.0, 3.5, 3.5}));
  for (std::size_t cluster = 0; cluster < 3; ++cluster) {
    EXPECT_EQ(offered.source_id(cluster, 1000), pairs.rows[cluster]) << "no source beside the rows";
  }
}

TEST(AmongSamples, WantsManyMomentsOfALongWindow) {
  Teuchos::ParameterList block("reduction.clustering");
  block.set("type", std::string("among samples")).set("sources", 16).set("ridge", 0.005);
  EXPECT_EQ(clustering_steps(block, 100, 150).size(), 50u) << "all of a short one";
  const std::vector<int> steps = clustering_steps(block, 0, 1000);
  EXPECT_EQ(steps.size(), 400u);
  EXPECT_EQ(steps.back(), 1000);
}

/// The chain with the mode cos(πx), sampled at four particles.
struct SampledChain {
  std::unique_ptr<Model> model;
  VectorView reference;
  std::vector<WindowReduction> windows;

  SampledChain() {
    Teuchos::ParameterList list("model");
    list.set("type", std::string("test chain")).set("count", 60).set("components", 1).set("diffusion", 30.0);
    list.set("reaction", 2.0).set("power", 40.0).set("velocity", 5.0);
    model = Registry<Model>::create(list, {test::world()});
    const Map& rows = *model->rows();
    reference = VectorView("reference", local_size(rows));
    MatrixView modes("modes", local_size(rows), 2);
    for (LocalIndex i = 0; i < local_size(rows); ++i) {
      const double x = static_cast<double>(rows.getGlobalElement(i)) / 60.0;
      for (int k = 0; k < 2; ++k) modes(i, k) = std::cos((k + 1) * 3.0 * x);
    }
    Pod basis;
    basis.modes = modes;
    basis.singular_values = {1.0, 0.5};
    basis.truncation.rank = 2;
    const std::vector<GlobalIndex> sampled = {10, 20, 30, 45};
    windows.push_back({1.0, basis, {}, {}, sampled, model->sampled(sampled), {}});
  }

  SourceClusters learn(const LearntStates& states) const {
    Teuchos::ParameterList block("reduction.clustering");
    block.set("type", std::string("among samples")).set("sources", 2).set("ridge", 0.005);
    return learn_clusters(block, *model, reference, windows, states).clusters;
  }
};

TEST(AmongSamples, FitsEachStateWithTheParametersItWasMetAt) {
  const SampledChain chain;
  const auto state = [](double a, double b) {
    VectorView coordinates("state", 2);
    coordinates(0) = a;
    coordinates(1) = b;
    return coordinates;
  };
  const LearntStates conducting{
      {{"diffusion"}, {{30.0}, {0.0}}}, {state(1, 0.2), state(2, -1), state(3, 0.5)}, {0, 0, 0}};
  LearntStates with_still = conducting;
  for (const double a : {-1.0, 4.0, 2.5}) {
    with_still.coordinates.push_back(state(a, 2.0));
    with_still.at.push_back(1);
  }
  const SourceClusters expected = chain.learn(conducting), found = chain.learn(with_still);
  EXPECT_EQ(found.row_clusters, expected.row_clusters);
  ASSERT_EQ(found.row_weights.size(), expected.row_weights.size());
  double moved = 0.0;
  LearntStates all_conducting = with_still;
  all_conducting.at.assign(6, 0);
  const SourceClusters other = chain.learn(all_conducting);
  for (std::size_t pair = 0; pair < expected.row_weights.size(); ++pair) {
    EXPECT_NEAR(found.row_weights[pair], expected.row_weights[pair], 1e-12 * std::abs(expected.row_weights[pair]))
        << "where nothing diffuses, pairs tell nothing";
    if (pair < other.row_weights.size()) moved += std::abs(other.row_weights[pair] - expected.row_weights[pair]);
  }
  EXPECT_GT(moved, 1e-3);
  EXPECT_EQ(chain.windows.front().sample->parameters().get("diffusion"), 30.0) << "as it was";
}

TEST(AmongSamples, NeedsTwoRows) {
  PairWeights pairs;
  pairs.rows = {5};
  pairs.sources = {6};
  pairs.weights = {1.0};
  pairs.offsets = {0, 1};
  try {
    among_samples().clusters(pairs, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "reduction.clustering: 1 particle is sampled, and has no others for sources; expected two sampled "
                 "particles at least, or another source clustering");
  }
}

}  // namespace
}  // namespace kiln
