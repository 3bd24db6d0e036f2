#include "physics/sph/Neighbours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kiln {
namespace {

IndexView all_of(std::size_t number) {
  IndexView targets("targets", number);
  for (std::size_t i = 0; i < number; ++i) targets(i) = static_cast<LocalIndex>(i);
  return targets;
}

std::vector<Point> random_cloud(int number, Point extent) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Point> points;
  for (int i = 0; i < number; ++i) {
    points.push_back({extent[0] * unit(generator), extent[1] * unit(generator), extent[2] * unit(generator)});
  }
  return points;
}

void expect_same_as_all_pairs(const std::vector<Point>& points, double radius) {
  const NeighbourList list = find_neighbours(position_view(points), all_of(points.size()), radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<LocalIndex> expected;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double r =
          std::hypot(points[i][0] - points[j][0], points[i][1] - points[j][1], points[i][2] - points[j][2]);
      if (j != i && r < radius * (1.0 - 1e-10)) expected.push_back(static_cast<LocalIndex>(j));
    }
    const std::vector<LocalIndex> found(list.neighbours.data() + list.offsets(i),
                                        list.neighbours.data() + list.offsets(i + 1));
    ASSERT_EQ(found, expected) << "particle " << i;
  }
}

TEST(Neighbours, AreThoseOfAllPairs) { expect_same_as_all_pairs(random_cloud(700, {1.0, 0.6, 0.3}), 0.17); }

TEST(Neighbours, AreThoseOfAllPairsInAFlatCloud) { expect_same_as_all_pairs(random_cloud(400, {2.0, 1.0, 0.0}), 0.2); }

TEST(Neighbours, AreThoseOfAllPairsInAHugeThinCloud) {
  std::vector<Point> points = random_cloud(300, {1.0, 1.0, 1.0});
  for (Point& point : random_cloud(300, {1e7, 1e7, 1e7})) points.push_back(point);
  expect_same_as_all_pairs(points, 0.3);
}

TEST(Neighbours, OfTheReportsLattice) {
  std::vector<Point> points;
  for (int k = 0; k < 14; ++k) {
    for (int j = 0; j < 50; ++j) {
      for (int i = 0; i < 100; ++i) points.push_back({i * 4e-3 / 99, -1e-3 + j * 2e-3 / 49, k * 0.5e-3 / 13});
    }
  }
  const double radius = 2.0 * 1.5 * 2e-3 / 49;
  const NeighbourList list = find_neighbours(position_view(points), all_of(points.size()), radius);
  EXPECT_EQ(list.neighbours.extent(0), 7871920u);
  EXPECT_NEAR(static_cast<double>(list.neighbours.extent(0)) / 70000.0, 112.46, 0.005);
}

TEST(Neighbours, ExactlyAtTheRadiusAreOutside) {
  const std::vector<Point> points = {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.3 * (1.0 - 1e-9), 0.0}};
  const NeighbourList list = find_neighbours(position_view(points), all_of(3), 0.3);
  ASSERT_EQ(list.offsets(1), 1u);
  EXPECT_EQ(list.neighbours(0), 2);
}

TEST(Neighbours, CoincidentPairIsFound) {
  std::vector<Point> points = random_cloud(200, {1.0, 1.0, 1.0});
  const PositionView apart = position_view(points);
  const IndexView targets = all_of(200);
  EXPECT_FALSE(coincident_pair(apart, targets, find_neighbours(apart, targets, 0.3), 0.3));
  points[150] = points[20];
  const PositionView together = position_view(points);
  const auto pair = coincident_pair(together, targets, find_neighbours(together, targets, 0.3), 0.3);
  ASSERT_TRUE(pair);
  EXPECT_EQ(*pair, std::make_pair(20, 150));
}

}  // namespace
}  // namespace kiln
