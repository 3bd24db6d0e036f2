#include "framework/base/ExchangeInterval.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace kiln {
namespace {

TEST(ExchangeInterval, BeginsWithTheFirstStep) {
  const ExchangeInterval from_start, continued(7);
  EXPECT_FALSE(from_start.due(0));
  EXPECT_TRUE(from_start.due(1));
  EXPECT_FALSE(continued.due(7));
  EXPECT_TRUE(continued.due(8));
}

TEST(ExchangeInterval, ComesAgainAfterAsManyStepsAsAgreed) {
  ExchangeInterval interval;
  interval.exchanged(1, 5);
  EXPECT_FALSE(interval.due(5));
  EXPECT_TRUE(interval.due(6));
  EXPECT_TRUE(interval.due(60));
}

TEST(ExchangeInterval, GuessesFromThePace) {
  using std::chrono::milliseconds;
  ExchangeInterval interval;
  interval.exchanged(10, 1);
  std::this_thread::sleep_for(milliseconds(50));
  // 10 steps in 50 ms or somewhat more: 50 of them in a quarter of a second at most.
  EXPECT_LE(interval.steps_to_come(20), 50);
  EXPECT_GT(interval.steps_to_come(20), 1);
  // One step in 0.3 s is longer than the interval.
  std::this_thread::sleep_for(milliseconds(250));
  EXPECT_EQ(interval.steps_to_come(11), 1);
  EXPECT_EQ(interval.steps_to_come(10), 1);
}

}  // namespace
}  // namespace kiln
