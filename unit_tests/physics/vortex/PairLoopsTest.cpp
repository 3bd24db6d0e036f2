#include "physics/vortex/PairLoops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace kiln {
namespace {

constexpr double tolerance = 1e-13;

/// Vortices in no pattern, among them two at one place and one at a target; 1,003 is no multiple of the lanes.
struct Scattered {
  static constexpr LocalIndex count = 1003;
  std::vector<double> x, y, circulation, points, tangents_x, tangents_y, tangents;

  explicit Scattered(int columns = 5) {
    for (int j = 0; j < count; ++j) {
      x.push_back(std::sin(12.9 * j + 0.3));
      y.push_back(std::cos(7.7 * j * j));
      circulation.push_back(std::sin(3.1 * j) / count);
    }
    x[7] = x[3];
    y[7] = y[3];
    for (int j = 0; j < count; ++j) points.insert(points.end(), {x[j], y[j]});
    const std::size_t padded = (count + vortex_multiple - 1) / vortex_multiple * vortex_multiple;
    for (auto* values : {&x, &y, &circulation}) values->resize(padded, 0.0);
    tangents_x.assign(padded * columns, 0.0);
    tangents_y.assign(padded * columns, 0.0);
    for (int c = 0; c < columns; ++c) {
      for (int j = 0; j < count; ++j) {
        tangents_x[c * padded + j] = std::cos(0.7 * j + c);
        tangents_y[c * padded + j] = std::sin(1.1 * j - c);
        tangents.insert(tangents.end(), {tangents_x[c * padded + j], tangents_y[c * padded + j]});
      }
    }
  }
  VortexArrays arrays() const {
    return {x.data(), y.data(), circulation.data(), count, static_cast<LocalIndex>(x.size())};
  }
};

/// Σ_j Γ_j q r⊥, D(q r⊥) v and its shear by the formulae, pair by pair.
template <class Law>
struct Plain {
  double u = 0.0, v = 0.0, shear = 0.0, du = 0.0, dv = 0.0;
  Plain(const Law& law, const Scattered& from, double at_x, double at_y, double tangent_x, double tangent_y) {
    for (int j = 0; j < Scattered::count; ++j) {
      const double dx = at_x - from.x[j], dy = at_y - from.y[j];
      const KernelSlope<double> q = law.slope(dx * dx + dy * dy + law.offset());
      const double ex = tangent_x - from.tangents_x[j], ey = tangent_y - from.tangents_y[j];
      const double along = 2.0 * q.slope * (dx * ex + dy * ey);
      u -= from.circulation[j] * q.value * dy;
      v += from.circulation[j] * q.value * dx;
      shear += from.circulation[j] * 2.0 * q.slope * dx * dy;
      du -= from.circulation[j] * (q.value * ey + along * dy);
      dv += from.circulation[j] * (q.value * ex + along * dx);
    }
  }
};

template <class Scalar, class Law>
void expect_plain_sums(const Law& law) {
  const Scattered from;
  const double targets[8] = {from.x[3], from.y[3], 0.4, -0.3, -2.0, 1.0, 0.05, 0.9};
  double sums[8];
  sum_at_four<Scalar>(law, from.arrays(), targets, sums);
  // A list in no order, made up with the target itself.
  std::vector<LocalIndex> sources;
  std::vector<double> circulations;
  for (int j = 0; j < Scattered::count; ++j) {
    const LocalIndex source = (j * 5) % Scattered::count;
    sources.push_back(2 * source);
    circulations.push_back(from.circulation[source]);
  }
  while (sources.size() % vortex_multiple != 0) {
    sources.push_back(2 * 3);
    circulations.push_back(0.0);
  }
  const auto listed = static_cast<LocalIndex>(sources.size());
  const auto padded = from.x.size();
  for (int t = 0; t < 4; ++t) {
    const double x = targets[2 * t], y = targets[2 * t + 1];
    double own[10];
    for (int c = 0; c < 5; ++c) {
      own[2 * c] = t == 0 ? from.tangents_x[c * padded + 3] : 0.3 * c;
      own[2 * c + 1] = t == 0 ? from.tangents_y[c * padded + 3] : -0.2 * c;
    }
    const Plain<Law> plain(law, from, x, y, own[0], own[1]);
    const double size = std::hypot(plain.u, plain.v), slope_size = std::hypot(plain.du, plain.dv);
    EXPECT_NEAR(sums[2 * t], plain.u, tolerance * size);
    EXPECT_NEAR(sums[2 * t + 1], plain.v, tolerance * size);
    double sum[2];
    sum_over_list<Scalar>(law, from.points.data(), sources.data(), circulations.data(), listed, x, y, sum);
    EXPECT_NEAR(sum[0], plain.u, tolerance * size);
    EXPECT_NEAR(sum[1], plain.v, tolerance * size);

    const ArrayReader arrays{from.arrays(), {from.tangents_x.data(), from.tangents_y.data(), padded}};
    const ListReader list{from.points.data(),
                          sources.data(),
                          circulations.data(),
                          listed,
                          {from.tangents.data(), 2 * Scattered::count, 5}};
    const double shear_size = std::max(std::abs(plain.shear), slope_size);
    EXPECT_NEAR((shear_at<Scalar>(law, arrays, x, y)), plain.shear, tolerance * shear_size);
    EXPECT_NEAR((shear_at<Scalar>(law, list, x, y)), plain.shear, tolerance * shear_size);
    double by_arrays[10], by_list[10];
    tangents_at<Scalar, 5>(law, arrays, x, y, own, by_arrays);
    tangents_at<Scalar, 5>(law, list, x, y, own, by_list);
    EXPECT_NEAR(by_arrays[0], plain.du, tolerance * slope_size);
    EXPECT_NEAR(by_arrays[1], plain.dv, tolerance * slope_size);
    for (int k = 0; k < 10; ++k) EXPECT_NEAR(by_list[k], by_arrays[k], 10.0 * tolerance * slope_size) << "entry " << k;
  }
}

TEST(PairLoops, NumberByNumberAreThePlainSums) {
  expect_plain_sums<double>(RosenheadMooreLaw(0.1));
  expect_plain_sums<double>(LambOseenLaw(0.1));
  expect_plain_sums<double>(LambOseenLaw(2.0));
}

TEST(PairLoops, LanesAreThePlainSums) {
  expect_plain_sums<VortexScalar>(RosenheadMooreLaw(0.1));
  expect_plain_sums<VortexScalar>(LambOseenLaw(0.1));
  expect_plain_sums<VortexScalar>(LambOseenLaw(0.02));
  expect_plain_sums<VortexScalar>(LambOseenLaw(2.0));
}

TEST(PairLoops, FourQuotientsOfOneDivide) {
  const double denominators[4] = {0.3, 7e10, 1e-12, 5.0};
  double quotients[4];
  share_divide(2.5, denominators, quotients);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(quotients[k], 2.5 / denominators[k], 1e-15 * quotients[k]);
}

TEST(PairLoops, AVortexDoesNotMoveItself) {
  const double x[8] = {0.3}, y[8] = {0.7}, circulation[8] = {5.0};
  const VortexArrays one{x, y, circulation, 1, vortex_multiple};
  const double targets[8] = {0.3, 0.7, 0.3, 0.7, 0.3, 0.7, 0.3, 0.7};
  double sums[8];
  sum_at_four<VortexScalar>(RosenheadMooreLaw(0.1), one, targets, sums);
  for (const double sum : sums) EXPECT_EQ(sum, 0.0);
  sum_at_four<VortexScalar>(LambOseenLaw(0.1), one, targets, sums);
  for (const double sum : sums) EXPECT_EQ(sum, 0.0);
}

}  // namespace
}  // namespace kiln
