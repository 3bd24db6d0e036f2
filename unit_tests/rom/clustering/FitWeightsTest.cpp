#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>

#include "framework/registry/Registry.hpp"
#include "rom/training/LearnClusters.hpp"
#include "unit_tests/rom/Chain.hpp"

namespace kiln {
namespace {

/// The chain with the modes cos 3x and cos 6x, sampled at four particles.
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
    block.set("type", std::string("among samples")).set("sources", 1).set("ridge", 0.005);
    return learn_clusters(block, *model, reference, windows, states).clusters;
  }
};

TEST(FitWeights, TakesEachStateWithTheParametersItWasMetAt) {
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

}  // namespace
}  // namespace kiln
