#include "rom/clustering/Partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "Random.hpp"

namespace kiln {
namespace {

using Parts = std::vector<std::vector<std::size_t>>;

Parts all_together(std::size_t count) {
  Parts groups(1);
  for (std::size_t i = 0; i < count; ++i) groups[0].push_back(i);
  return groups;
}

std::vector<double> mean_of(const Points& points, const std::vector<double>& weights,
                            const std::vector<std::size_t>& part) {
  std::vector<double> mean(points.dimension, 0.0);
  double weight = 0.0;
  for (const std::size_t m : part) {
    weight += weights[m];
    for (std::size_t k = 0; k < points.dimension; ++k) mean[k] += weights[m] * points[m][k];
  }
  for (double& value : mean) value /= weight;
  return mean;
}

double scatter(const Points& points, const std::vector<double>& weights, const Parts& parts) {
  double sum = 0.0;
  for (const std::vector<std::size_t>& part : parts) {
    const std::vector<double> mean = mean_of(points, weights, part);
    for (const std::size_t m : part) sum += weights[m] * squared_distance(points[m], mean.data(), points.dimension);
  }
  return sum;
}

struct Cloud {
  Cloud(unsigned seed, std::size_t count, std::size_t dimension) : points{dimension, {}} {
    test::Random random(seed);
    for (std::size_t i = 0; i < count * dimension; ++i) points.values.push_back(random.between(-1.0, 1.0));
    for (std::size_t i = 0; i < count; ++i) weights.push_back(random.between(0.1, 2.0));
  }
  Points points;
  std::vector<double> weights;
};

TEST(Partition, TellsGroupsApartThatLieApart) {
  Cloud cloud(3, 60, 3);
  Parts expected(4);
  for (std::size_t i = 0; i < 60; ++i) {
    cloud.points.values[3 * i] += 10.0 * static_cast<double>(i % 4 / 2);
    cloud.points.values[3 * i + 2] -= 15.0 * static_cast<double>(i % 2);
    expected[i % 4].push_back(i);
  }
  EXPECT_EQ(partition(cloud.points, cloud.weights, all_together(60), 4), expected);
}

/// The best of all partitions of nine points into three parts: few start values lead Lloyd's iteration far astray.
TEST(Partition, IsNearlyTheBestOne) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Cloud cloud(seed, 9, 2);
    double best = std::numeric_limits<double>::infinity();
    for (int code = 0; code < 19683; ++code) {
      Parts parts(3);
      for (int i = 0, rest = code; i < 9; ++i, rest /= 3) parts[rest % 3].push_back(i);
      parts.erase(std::remove_if(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); }),
                  parts.end());
      best = std::min(best, scatter(cloud.points, cloud.weights, parts));
    }
    const Parts found = partition(cloud.points, cloud.weights, all_together(9), 3);
    EXPECT_LE(found.size(), 3u);
    const double ratio = scatter(cloud.points, cloud.weights, found) / best;
    EXPECT_GE(ratio, 1.0 - 1e-12);
    worst = std::max(worst, ratio);
  }
  EXPECT_LT(worst, 1.7);
}

TEST(Partition, LeavesEachPointWithItsNearestMeanAndLessScatterWithMoreParts) {
  const Cloud cloud(11, 112, 7);
  double last = std::numeric_limits<double>::infinity();
  for (const std::size_t count : {1, 2, 4, 8, 16, 32, 111}) {
    const Parts parts = partition(cloud.points, cloud.weights, all_together(112), count);
    EXPECT_EQ(parts.size(), count);
    std::vector<int> times(112, 0);
    std::vector<std::vector<double>> means;
    for (const auto& part : parts) means.push_back(mean_of(cloud.points, cloud.weights, part));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      EXPECT_TRUE(std::is_sorted(parts[p].begin(), parts[p].end()));
      if (p > 0) {
        EXPECT_LT(parts[p - 1].front(), parts[p].front());
      }
      for (const std::size_t m : parts[p]) {
        ++times[m];
        for (const std::vector<double>& other : means) {
          EXPECT_LE(squared_distance(cloud.points[m], means[p].data(), 7),
                    squared_distance(cloud.points[m], other.data(), 7) * (1.0 + 1e-8));
        }
      }
    }
    EXPECT_EQ(times, std::vector<int>(112, 1));
    const double now = scatter(cloud.points, cloud.weights, parts);
    EXPECT_LT(now, last);
    last = now;
  }
}

TEST(Partition, KeepsGroupsApart) {
  const Cloud cloud(5, 40, 2);
  Parts groups(3);
  for (std::size_t i = 0; i < 40; ++i) groups[i % 2 == 0 ? 0 : 2].push_back(i);
  for (const std::size_t count : {1, 2, 5, 12}) {
    const Parts parts = partition(cloud.points, cloud.weights, groups, count);
    EXPECT_EQ(parts.size(), std::max<std::size_t>(2, count));
    for (const auto& part : parts) {
      for (const std::size_t m : part) EXPECT_EQ(m % 2, part.front() % 2);
    }
  }
}

/// As in a symmetric problem, points coincide in pairs: they stay together, whatever round-off adds.
TEST(Partition, DoesNotSeeRoundOff) {
  test::Random random(17);
  Points lattice{4, {}};
  std::vector<double> weights;
  for (int i = 0; i < 7; ++i) {
    for (int j = -3; j <= 3; ++j) {
      for (int k = 0; k < 4; ++k) lattice.values.push_back(300.0 + i * (k + 1.0) + 0.1 * j * j);
      weights.push_back(1.0 + std::abs(j));
    }
  }
  std::map<std::size_t, Parts> expected;
  for (int trial = 0; trial < 20; ++trial) {
    Points points = lattice;
    if (trial > 0) {
      for (double& value : points.values) value *= 1.0 + 1e-13 * random.between(-1.0, 1.0);
    }
    for (const std::size_t count : {6, 12, 40}) {
      const Parts parts = partition(points, weights, all_together(49), count);
      if (count == 40) {
        // 7 × 4 different places.
        EXPECT_EQ(parts.size(), 28u);
        for (const auto& part : parts) EXPECT_EQ(part.size(), part.front() % 7 == 3 ? 1u : 2u);
      }
      if (trial == 0) expected[count] = parts;
      EXPECT_EQ(parts, expected[count]) << trial;
    }
  }
}

}  // namespace
}  // namespace kiln
