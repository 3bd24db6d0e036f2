#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

class IncludeTest : public InputTest {};

TEST_F(IncludeTest, MergesUnderneath) {
  write("common/base.yaml", "title: base\nmodel:\n  spacing: 1 mm\n  porosity: 2 %\n" +
                                std::string("  heat_source: {type: gaussian lamp, power: 40 W, width: 9}\n"));
  write("common/more.yaml", "include: base.yaml\ntime: {step: 1 ms}\ntitle: more\n");
  const Input input = read_text("include: common/more.yaml\nmodel:\n  porosity: 3 %\n  heat_source: {power: 50 W}\n");
  EXPECT_EQ(input.list().get<std::string>("title"), "more");
  EXPECT_EQ(input.list().sublist("time").get<double>("step"), 1e-3);
  EXPECT_EQ(input.list().sublist("model").get<double>("porosity"), 0.03);
  EXPECT_EQ(input.list().sublist("model").sublist("heat_source").get<double>("power"), 50);
  EXPECT_EQ(input.list().sublist("model").sublist("heat_source").get<double>("width"), 9);
  EXPECT_EQ(to_string(input.location("model.spacing")), "common/base.yaml:3:12");
  EXPECT_EQ(to_string(input.location("model.porosity")), "run.yaml:3:13");
  EXPECT_EQ(to_string(input.location("time.end")), "common/more.yaml:2:1") << "a default stands at its block";
}

TEST_F(IncludeTest, LaterFilesWin) {
  write("a.yaml", model + "title: a\ntime: {step: 1 ms}\n");
  write("b.yaml", "title: b\n");
  const Input input = read_text("include: [a.yaml, b.yaml]\n");
  EXPECT_EQ(input.list().get<std::string>("title"), "b");
  EXPECT_EQ(input.list().sublist("time").get<double>("step"), 1e-3);
}

TEST_F(IncludeTest, ABlockOfAnotherTypeReplaces) {
  write("a.yaml", model);
  const Input input = read_text("include: a.yaml\nmodel: {heat_source: {type: uniform}}\n");
  EXPECT_EQ(input.list().sublist("model").sublist("heat_source").get<std::string>("type"), "uniform");
}

TEST_F(IncludeTest, FilesLieBesideTheFileThatNamesThem) {
  write("common/steel.csv", "1");
  write("common/base.yaml", model + "  table: steel.csv\n");
  const Input input = read_text("include: common/base.yaml\n");
  EXPECT_EQ(input.list().sublist("model").get<std::string>("table"), folder_ + "/common/steel.csv");
}

TEST_F(IncludeTest, MistakesNameTheirFile) {
  write("common/base.yaml", model + "tilte: a\n");
  EXPECT_EQ(mistakes_of("include: ./common/../common/base.yaml\ntime: {end: 0}\n"),
            (Lines{"run.yaml:2:13: time.end: '0' is not above 0; expected a time in s above 0",
                   "common/base.yaml:4:1: tilte: unknown key; expected one of: title, model, time, output; did you "
                   "mean 'title'?"}));
}

TEST_F(IncludeTest, AMissingTypeIsSoughtWhereTheBlockBegins) {
  write("base.yaml", "model:\n  spacing: 1 m\n  heat_source:\n    tpye: uniform\n");
  const Lines lines = mistakes_of("include: base.yaml\nmodel: {heat_source: {power: 1 W}}\n");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].rfind("base.yaml:4:5: model.heat_source: the key 'type' is missing", 0), 0u) << lines[0];
}

TEST_F(IncludeTest, WhatCannotBeIncludedIsTold) {
  EXPECT_EQ(mistakes_of("include: [absent.yaml, nowhere.yaml]\n"),
            (Lines{"run.yaml:1:11: include: there is no such file: absent.yaml",
                   "run.yaml:1:24: include: there is no such file: nowhere.yaml"}));
  const Lines long_name = mistakes_of("include: " + std::string(5000, 'a') + "\n");
  ASSERT_EQ(long_name.size(), 1u);
  EXPECT_LT(long_name[0].size(), 1200u) << "a message holds no more of a name than can be read";
  EXPECT_EQ(mistakes_of("include: {a: 1}\n"),
            Lines{"run.yaml:1:1: include: no file name is given; expected a file or a list of files"});
  write("list.yaml", "- a\n");
  EXPECT_EQ(mistakes_of("include: list.yaml\n"),
            Lines{"list.yaml:1:1: a list at top level; expected 'key: value' lines"});
  write("a.yaml", "include: b.yaml\n");
  write("b.yaml", "include: run.yaml\n");
  EXPECT_EQ(mistakes_of("include: a.yaml\n"),
            Lines{"b.yaml:1:10: include: the file includes itself: run.yaml -> a.yaml -> b.yaml -> run.yaml"});
}

TEST_F(IncludeTest, TooManyFilesAreRefused) {
  for (int i = 0; i < 10; ++i) {
    const std::string next = std::to_string(i + 1) + ".yaml";
    write(std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  write("10.yaml", model);
  const Lines lines = mistakes_of("include: 0.yaml\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("include: more than 99 files are included"), std::string::npos) << lines[0];
}

}  // namespace
}  // namespace kiln::test
