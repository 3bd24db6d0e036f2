#include "physics/sph/Distribution.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace kiln {
namespace {

/// Largest part's pairs over the mean, after checking that every particle is in exactly one part.
double imbalance(const std::vector<Point>& points, double radius, int parts) {
  const std::vector<double> work = neighbour_counts(points, radius, *Tpetra::getDefaultComm());
  std::vector<int> seen(points.size(), 0);
  double largest = 0.0;
  for (int part = 0; part < parts; ++part) {
    double sum = 0.0;
    const std::vector<GlobalIndex> ids = coordinate_bisection(points, work, parts, part);
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    for (const GlobalIndex id : ids) {
      ++seen[id];
      sum += work[id];
    }
    largest = std::max(largest, sum);
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(points.size()));
  return largest * parts / std::accumulate(work.begin(), work.end(), 0.0);
}

TEST(Distribution, OfALatticeIsBalanced) {
  std::vector<Point> points;
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 25; ++j) {
      for (int i = 0; i < 50; ++i) points.push_back({1.0 * i, 1.0 * j, 1.0 * k});
    }
  }
  for (const int parts : {2, 3, 4, 7, 16}) EXPECT_LT(imbalance(points, 3.0, parts), 1.01) << parts << " parts";
}

TEST(Distribution, OfAGradedCloudIsBalanced) {
  std::vector<Point> points;
  for (int k = 0; k < 8; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 80; ++i) points.push_back({20.0 * std::expm1(i / 30.0), 1.0 * j, 1.0 * k});
    }
  }
  // Counting particles instead of pairs would be worse than this.
  for (const int parts : {2, 3, 4, 7, 16}) EXPECT_LT(imbalance(points, 3.0, parts), 1.02) << parts << " parts";
  const std::vector<double> equal(points.size(), 1.0);
  const std::vector<double> work = neighbour_counts(points, 3.0, *Tpetra::getDefaultComm());
  double half = 0.0;
  for (const GlobalIndex id : coordinate_bisection(points, equal, 2, 0)) half += work[id];
  EXPECT_GT(2.0 * half / std::accumulate(work.begin(), work.end(), 0.0), 1.1);
}

TEST(Distribution, OfClustersIsBalanced) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<Point> points;
  for (int cluster = 0; cluster < 5; ++cluster) {
    const double centre = 9.0 * cluster;
    for (int i = 0; i < 300 * (cluster + 1); ++i) {
      points.push_back({centre + normal(generator), 0.4 * centre + normal(generator), normal(generator)});
    }
  }
  for (const int parts : {2, 3, 4, 7}) EXPECT_LT(imbalance(points, 1.0, parts), 1.05) << parts << " parts";
}

TEST(Distribution, MorePartsThanParticles) {
  const std::vector<Point> points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  imbalance(points, 1.5, 8);
}

}  // namespace
}  // namespace kiln
