#include "framework/base/Nearest.hpp"

#include <gtest/gtest.h>

namespace kiln {
namespace {

TEST(Nearest, AllowsAThirdOfTheWord) {
  EXPECT_EQ(nearest("powr", {"width", "power"}), "power");
  EXPECT_EQ(nearest("wdith", {"width", "power"}), "width");
  EXPECT_EQ(nearest("POWER", {"power"}), "power");
  EXPECT_EQ(nearest("xyz", {"width", "power"}), "");
  EXPECT_EQ(nearest("ab", {"ac"}), "ac");
  EXPECT_EQ(nearest("ab", {"cd"}), "");
  EXPECT_EQ(nearest("", {"a"}), "a");
  EXPECT_EQ(nearest(std::string(100, 'a'), {std::string(100, 'a')}), "");
}

}  // namespace
}  // namespace kiln
