#include "framework/driver/Placeholders.hpp"

#include <gtest/gtest.h>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

const PlaceholderValues values = {{"method", "gnat"}, {"tolerance", "1e-3"}};

std::string mistake(const std::string& text, const PlaceholderValues& known = values) {
  try {
    fill_placeholders(text, known);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Placeholders, AreReplaced) {
  EXPECT_EQ(fill_placeholders("{method}-{tolerance}/{method}", values), "gnat-1e-3/gnat");
  EXPECT_EQ(fill_placeholders("", values), "");
  EXPECT_EQ(fill_placeholders("plain", {}), "plain");
}

TEST(Placeholders, ValuesAreNotLookedAtAgain) {
  EXPECT_EQ(fill_placeholders("{a}", {{"a", "{b}"}, {"b", "c"}}), "{b}");
}

TEST(Placeholders, DoubledBracesStandForThemselves) {
  EXPECT_EQ(fill_placeholders("{{type: {method}}}", values), "{type: gnat}");
}

TEST(Placeholders, UnknownNamesAreRefused) {
  EXPECT_EQ(mistake("{tolerence}"),
            "{tolerence} in '{tolerence}' has no value; expected one of: method, tolerance; did you mean 'tolerance'?");
  EXPECT_EQ(mistake("a{x}", {}), "{x} in 'a{x}' has no value; expected no placeholders: the case has no block 'for'");
}

TEST(Placeholders, UnmatchedBracesAreRefused) {
  for (const char* text : {"{method", "method}", "{{method}", "{method{", "{"}) {
    EXPECT_NE(mistake(text).find("without its partner"), std::string::npos) << text << ": " << mistake(text);
  }
}

TEST(Combinations, AreTheProductWithTheLastNameFastest) {
  const auto product = combinations({{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}});
  ASSERT_EQ(product.size(), 6U);
  EXPECT_EQ(product[0], (PlaceholderValues{{"a", "1"}, {"b", "x"}}));
  EXPECT_EQ(product[1], (PlaceholderValues{{"a", "1"}, {"b", "y"}}));
  EXPECT_EQ(product[3], (PlaceholderValues{{"a", "2"}, {"b", "x"}}));
  EXPECT_EQ(combinations({}), std::vector<PlaceholderValues>(1));
}

}  // namespace
}  // namespace kiln
