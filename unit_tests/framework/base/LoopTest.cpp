#include "framework/base/Loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kiln {
namespace {

TEST(Sum, TakesEachIndexOnce) {
  // Around every vector length; powers of two show which one is missing or doubled.
  for (LocalIndex count = 0; count <= 50; ++count) {
    const double found =
        sum("kiln::test::powers", count, [](LocalIndex i) { return std::ldexp(1.0, static_cast<int>(i)); });
    EXPECT_EQ(found, std::ldexp(1.0, static_cast<int>(count)) - 1.0) << count;
  }
}

TEST(Sum, KeepsWhatItsBodyWrites) {
  const VectorView squares("squares", 37);
  const auto written = borrowed(squares);
  const double found = sum("kiln::test::squares", 37, [=](LocalIndex i) {
    written(i) = static_cast<double>(i) * static_cast<double>(i);
    return written(i);
  });
  EXPECT_EQ(found, 36.0 * 37.0 * 73.0 / 6.0);
  for (int i = 0; i < 37; ++i) EXPECT_EQ(squares(i), i * i);
}

/// Divergence is told by sums that are not finite.
TEST(Sum, OfOneNumberThatIsNoneIsNone) {
  for (LocalIndex bad = 0; bad < 20; ++bad) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(sum("kiln::test::nan", 20, [=](LocalIndex i) { return i == bad ? nan : 1.0; }))) << bad;
  }
}

}  // namespace
}  // namespace kiln
