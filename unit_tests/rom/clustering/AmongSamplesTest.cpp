#include "rom/clustering/AmongSamples.hpp"

#include <gtest/gtest.h>

#include "framework/base/Error.hpp"
#include "rom/training/LearnClusters.hpp"

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
