#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "physics/vortex/Quadtree.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

VortexCase tree_case(double opening, int leaf = 8) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::two_patches(0.1);
  vortex_case.sum = VortexCase::barnes_hut(opening, leaf);
  return vortex_case;
}

std::vector<double> rates(const VortexCase& vortex_case) {
  const auto model = vortex_case.model();
  return gathered(*model->rows(), rate_of(*model, initial_state_of(*model)));
}

/// Largest difference relative to the largest rate.
double difference(const std::vector<double>& found, const std::vector<double>& expected) {
  double most = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    most = std::max(most, std::abs(found[i] - expected[i]));
    largest = std::max(largest, std::abs(expected[i]));
  }
  return most / largest;
}

TEST(BarnesHut, WithoutOpeningIsTheDirectSum) {
  VortexCase direct = tree_case(0.0);
  direct.sum = Teuchos::ParameterList("model.sum").set("type", std::string("direct"));
  for (const std::string kernel : {"rosenhead-moore", "lamb-oseen"}) {
    direct.kernel = kernel;
    for (const int leaf : {1, 7, 100000}) {
      VortexCase tree = tree_case(0.0, leaf);
      tree.kernel = kernel;
      EXPECT_LT(difference(rates(tree), rates(direct)), 1e-13) << kernel << ", leaf " << leaf;
    }
  }
}

TEST(BarnesHut, ErrorFallsWithTheOpening) {
  const std::vector<double> exact = rates(tree_case(0.0));
  double before = 1.0;
  for (const double opening : {1.2, 0.6, 0.3, 0.15}) {
    const double error = difference(rates(tree_case(opening)), exact);
    if (Tpetra::getDefaultComm()->getRank() == 0) std::printf("opening %.2f: error %.2e\n", opening, error);
    EXPECT_GT(error, 0.0) << "no box was taken whole";
    EXPECT_LT(error, 0.5 * before);
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(BarnesHut, SampledRowsAreTheWholeModelsOnAnyNumberOfRanks) {
  const auto model = tree_case(0.5).model();
  contract::check_sampled(*model, {900, 3, 44, 201, 0, 99, 98});
  EXPECT_EQ(rates(tree_case(0.5)).size(), 2 * tree_case(0.5).cloud().x.size());
  const auto single = tree_case(0.5).model(alone());
  EXPECT_LT(difference(rates(tree_case(0.5)), gathered(*single->rows(), rate_of(*single, initial_state_of(*single)))),
            1e-14);
}

VortexArrays arrays_of(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& g) {
  const auto count = static_cast<LocalIndex>(x.size());
  return {x.data(), y.data(), g.data(), count, count};
}

TEST(Quadtree, HoldsEveryVortexOnceAndSumsItsSquares) {
  const VortexCloud cloud = tree_case(0.5).cloud();
  Quadtree tree(5);
  tree.build(arrays_of(cloud.x, cloud.y, cloud.circulation));
  std::set<LocalIndex> places;
  std::size_t in_leaves = 0;
  for (const QuadtreeNode& node : tree.nodes()) {
    double sums[2] = {0.0, 0.0}, moments[2] = {0.0, 0.0};
    for (LocalIndex k = node.first; k < node.last; ++k) {
      EXPECT_GE(tree.x()[k], node.lower[0]);
      EXPECT_LE(tree.x()[k], node.upper[0]);
      EXPECT_GE(tree.y()[k], node.lower[1]);
      EXPECT_LE(tree.y()[k], node.upper[1]);
      const double circulation = tree.circulation()[k];
      EXPECT_EQ(circulation, cloud.circulation[tree.place(k)]);
      sums[circulation < 0.0 ? 1 : 0] += circulation;
      moments[circulation < 0.0 ? 1 : 0] += circulation * tree.y()[k];
      if (node.children == 0) {
        places.insert(tree.place(k));
        ++in_leaves;
      }
    }
    for (int sign = 0; sign < 2; ++sign) {
      EXPECT_NEAR(node.monopole[sign].circulation, sums[sign], 1e-14);
      EXPECT_NEAR(node.monopole[sign].y * node.monopole[sign].circulation, moments[sign], 1e-14);
    }
    if (node.children == 0) {
      EXPECT_LE(node.count(), 5);
    }
  }
  EXPECT_EQ(places.size(), cloud.x.size());
  EXPECT_EQ(in_leaves, cloud.x.size());
}

TEST(Quadtree, EndsForVorticesAtOnePlaceAndForNoNumbers) {
  std::vector<double> x(40, 0.3), y(40, -0.2), circulation(40, 1.0);
  Quadtree tree(4);
  tree.build(arrays_of(x, y, circulation));
  EXPECT_EQ(tree.nodes().size(), 1u);
  x[0] = 0.7;
  tree.build(arrays_of(x, y, circulation));
  EXPECT_EQ(tree.nodes().size(), 3u);
  for (const double hostile : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < x.size(); i += 3) x[i] = hostile;
    tree.build(arrays_of(x, y, circulation));
    EXPECT_EQ(tree.nodes()[0].count(), 40);
  }
  tree.build(arrays_of({}, {}, {}));
  EXPECT_TRUE(tree.nodes().empty());
}

TEST(BarnesHut, AStateThatIsNotFiniteGivesARateThatIsNotFinite) {
  const auto model = tree_case(0.5).model();
  const VectorView u = initial_state_of(*model);
  if (u.extent(0) > 0) u(0) = std::nan("");
  const VectorView f = rate_of(*model, u);
  if (f.extent(0) > 0) {
    EXPECT_FALSE(std::isfinite(f(0)));
  }
}

}  // namespace
}  // namespace kiln
