#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

class AliasTest : public InputTest {};

TEST_F(AliasTest, RepeatsValuesAndBlocks) {
  const Input input = read_text(
      "model:\n"
      "  spacing: &length 2 mm\n"
      "  origin: [*length, 0, *length]\n"
      "  heat_source: &lamp {type: gaussian lamp, power: 40 W, width: 1 mm}\n"
      "  more_sources:\n"
      "    - *lamp\n"
      "    - {<<: *lamp, power: 50 W}\n");
  const Teuchos::ParameterList& block = input.list().sublist("model");
  EXPECT_EQ(block.get<Teuchos::Array<double>>("origin"), reals({2e-3, 0., 2e-3}));
  const Teuchos::ParameterList& sources = block.sublist("more_sources");
  EXPECT_EQ(sources.sublist("0").get<double>("power"), 40);
  EXPECT_EQ(sources.sublist("1").get<double>("power"), 50);
  EXPECT_EQ(sources.sublist("1").get<double>("width"), 1e-3);
}

TEST_F(AliasTest, MergesSeveralBlocksTheFirstWins) {
  const Input input = read_text(
      "model:\n"
      "  spacing: 1\n"
      "  heat_source: &a {type: gaussian lamp, power: 1, width: 2}\n"
      "  more_sources: [&b {type: gaussian lamp, power: 3, velocity: [4, 5]}, {<<: [*a, *b], width: 6}]\n");
  const Teuchos::ParameterList& merged = input.list().sublist("model").sublist("more_sources").sublist("1");
  EXPECT_EQ(merged.get<double>("power"), 1);
  EXPECT_EQ(merged.get<double>("width"), 6);
  EXPECT_EQ(merged.get<Teuchos::Array<double>>("velocity"), reals({4., 5.}));
}

TEST_F(AliasTest, MistakesStandWhereTheAliasIs) {
  EXPECT_EQ(mistakes_of("title: &t four\n" + model + "time: {step: *t}\n"),
            Lines{"run.yaml:5:14: time.step: 'four' is not a number; expected a time in s above 0 and at most 0.5 s"});
  EXPECT_EQ(mistakes_of(model + "title: *nothing\n"),
            Lines{"run.yaml:4:8: an alias without an anchor; expected an '&name' further up in the file"});
  EXPECT_EQ(mistakes_of(model + "time: {<<: 4}\n"),
            Lines{"run.yaml:4:12: time.<<: '<<' without a block; expected an alias of a block, or a list of such"});
}

TEST_F(AliasTest, CyclesAreRefused) {
  EXPECT_EQ(mistakes_of("model: &m\n  spacing: 1\n  kernel: *m\n"),
            Lines{"run.yaml:3:11: this alias stands inside the value it repeats"});
  EXPECT_EQ(mistakes_of("title: &t [*t]\n"), Lines{"run.yaml:1:12: this alias stands inside the value it repeats"});
}

TEST_F(AliasTest, ExplosionsAreRefused) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) text += ", " + before;
    text += "]\n";
  }
  const Lines lines = mistakes_of(text);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].substr(lines[0].find(' ') + 1), "aliases repeat more than 100000 values");
}

}  // namespace
}  // namespace kiln::test
