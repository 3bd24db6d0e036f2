#include "framework/files/Compare.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "framework/base/Error.hpp"
#include "framework/files/RunFile.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

/// Frames of steps 0, 1, 2; the last one only when asked for.
void write_run(const std::string& path, int frames = 3, double added = 0.0, const char* field = "temperature",
               const std::vector<GlobalIndex>& ids = {0, 1, 2, 3, 4}) {
  std::filesystem::create_directories(path);
  const Map map(ids.size(), Teuchos::arrayViewFromVector(ids), 0, world());
  PositionView positions("kiln::test::positions", ids.size());
  VectorView u("kiln::test::state", ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) positions(i, 0) = 1e-3 * static_cast<double>(ids[i]);
  RunFile file(path, map, positions, {{{field, "K"}}, {0, 1, 2}, {}}, 0, world());
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      u(i) = 300.0 + 10.0 * static_cast<double>(ids[i]) + frame + (frame == 1 && ids[i] == 3 ? added : 0.0);
    }
    file.write(frame, 0.5 * frame, u);
  }
}

/// A run folder's whole set of files.
void write_folder(const std::string& path, const std::string& last_probe = "301.5") {
  write_run(path);
  write_text(path + "/probes.csv", "step,time [s],probe 1 temperature [K]\n0,0,300\n1,0.5," + last_probe + "\n");
  write_text(path + "/report.json", R"({"fom": {"steps": 2, "wall_s": )" + std::to_string(std::rand()) +
                                        R"(, "peak_kelvin": 301.5}, "provenance": {"ranks": 1}, "note": "text"})");
}

void expect_different(const CompareResult& result, const std::string& words) {
  EXPECT_FALSE(result.same());
  EXPECT_NE(result.text().find(words), std::string::npos) << words << " not in:\n" << result.text();
}

TEST(Compare, EqualRunsAreSame) {
  TestFolder folder;
  write_folder(folder / "a");
  write_folder(folder / "b");
  const CompareResult result = compare(folder / "a", folder / "b", {0.0, 0.0});
  EXPECT_TRUE(result.same()) << result.text();
  // Temperatures, times, steps, ids and coordinates; 2 rows of 3; steps and peak_kelvin.
  EXPECT_EQ(result.compared(), 15u + 3u + 3u + 5u + 15u + 6u + 2u);
  EXPECT_NE(result.text().find("same  run.h5:/temperature"), std::string::npos) << result.text();
}

TEST(Compare, TellsWhereTheWorstDifferenceIs) {
  TestFolder folder;
  write_run(folder / "a");
  write_run(folder / "b", 3, 0.331);
  const CompareResult result = compare(folder / "a/run.h5", folder / "b/run.h5", {1e-6, 0.0});
  expect_different(result, "frame 1, t = 0.5 s, particle 3 at (0.003, 0, 0) m");
  const auto field = std::find_if(result.fields.begin(), result.fields.end(),
                                  [](const FieldDifference& f) { return f.field == "/temperature"; });
  ASSERT_NE(field, result.fields.end());
  EXPECT_EQ(field->failed, 1u);
  EXPECT_NEAR(field->worst, 0.331 / 331.331, 1e-12);
  EXPECT_EQ(field->a, 331.0);
  EXPECT_TRUE(compare(folder / "a/run.h5", folder / "b/run.h5", {1.001e-3, 0.0}).same());
  EXPECT_FALSE(compare(folder / "a/run.h5", folder / "b/run.h5", {0.998e-3, 0.0}).same());
  EXPECT_TRUE(compare(folder / "a/run.h5", folder / "b/run.h5", {1e-6, 0.332e6}).same()) << "the floor counts";
}

TEST(Compare, MissingThingsFail) {
  TestFolder folder;
  write_folder(folder / "a");
  write_folder(folder / "b");
  expect_different(compare(folder / "a", folder / "none", {1.0, 1.0}), "none is missing");
  expect_different(compare(folder / "none", folder / "a", {1.0, 1.0}), "none is missing");
  std::filesystem::remove(folder / "b/probes.csv");
  expect_different(compare(folder / "a", folder / "b", {1.0, 1.0}), "probes.csv is missing in " + (folder / "b"));
  expect_different(compare(folder / "b", folder / "a", {1.0, 1.0}), "probes.csv is missing in " + (folder / "b"));
  write_run(folder / "c", 3, 0.0, "pressure");
  expect_different(compare(folder / "a/run.h5", folder / "c/run.h5", {1.0, 1e9}), "/temperature is missing in");
  expect_different(compare(folder / "a/run.h5", folder / "b", {1.0, 1.0}), "is a folder");
  expect_different(compare(folder / "a/run.h5", folder / "a/report.json", {1.0, 1.0}), "different kinds");
}

TEST(Compare, EmptiedGoldFails) {
  TestFolder folder;
  std::filesystem::create_directories(folder / "empty");
  std::filesystem::create_directories(folder / "void");
  write_folder(folder / "a");
  expect_different(compare(folder / "empty", folder / "void", {1.0, 1.0}), "nothing was compared");
  expect_different(compare(folder / "empty", folder / "a", {1.0, 1.0}), "run.h5 is missing");
  write_text(folder / "empty/empty.csv", "");
  write_text(folder / "void/empty.csv", "");
  expect_different(compare(folder / "empty/empty.csv", folder / "void/empty.csv", {1.0, 1.0}), "is empty");
  write_text(folder / "empty/empty.csv", "step,a\n");
  write_text(folder / "void/empty.csv", "step,a\n");
  expect_different(compare(folder / "empty/empty.csv", folder / "void/empty.csv", {1.0, 1.0}), "nothing was compared");
  write_text(folder / "empty/a.json", "{}");
  write_text(folder / "void/a.json", "{}");
  expect_different(compare(folder / "empty/a.json", folder / "void/a.json", {1.0, 1.0}), "nothing was compared");
  write_text(folder / "empty/a.h5", "");
  expect_different(compare(folder / "empty/a.h5", folder / "a/run.h5", {1.0, 1.0}), "is not an HDF5 file");
}

TEST(Compare, FramesThatNeitherHasAreSkippedAndOneSidesFail) {
  TestFolder folder;
  write_run(folder / "a", 2);
  write_run(folder / "b", 2);
  write_run(folder / "c", 3);
  const CompareResult both = compare(folder / "a/run.h5", folder / "b/run.h5", {0.0, 0.0});
  EXPECT_TRUE(both.same()) << both.text();
  EXPECT_FALSE(compare(folder / "a/run.h5", folder / "c/run.h5", {1.0, 1e9}).same());
  EXPECT_FALSE(compare(folder / "c/run.h5", folder / "a/run.h5", {1.0, 1e9}).same());
}

/// Full order and a reduced run, which holds some of the particles only.
TEST(Compare, OfDifferentParticlesOnlyTheCommonOnes) {
  TestFolder folder;
  write_run(folder / "a");
  write_run(folder / "b", 3, 0.331, "temperature", {4, 3, 1});
  const auto found = [&](double tolerance, bool common) {
    return compare(folder / "a/run.h5", folder / "b/run.h5", {tolerance, 0.0, {}, common});
  };
  expect_different(found(1e-2, false), "FAULT /particle has shape 5 and 3");
  const CompareResult result = found(1e-6, true);
  expect_different(result, "frame 1, t = 0.5 s, particle 3 at (0.003, 0, 0) m");
  EXPECT_TRUE(found(1.001e-3, true).same()) << found(1.001e-3, true).text();
  EXPECT_NE(result.text().find("ALONE 5 and 3 particles, 3 of them common"), std::string::npos) << result.text();
  // Temperatures, times, steps and coordinates.
  EXPECT_EQ(result.compared(), 9u + 3u + 3u + 9u);
  const CompareResult reversed = compare(folder / "b/run.h5", folder / "a/run.h5", {1.001e-3, 0.0, {}, true});
  EXPECT_TRUE(reversed.same()) << reversed.text();
  write_run(folder / "c", 3, 0.0, "pressure", {4, 3, 1});
  const CompareResult other = compare(folder / "a/run.h5", folder / "c/run.h5", {0.0, 0.0, {}, true});
  EXPECT_NE(other.text().find("ALONE /temperature is missing in"), std::string::npos) << other.text();
  expect_different(other, "FAULT there is no field that both hold");
  // What leaves nothing to compare is no agreement.
  const auto common_with = [&](const std::string& name) {
    return compare(folder / "a/run.h5", folder / (name + "/run.h5"), {1.0, 1e9, {}, true});
  };
  write_run(folder / "d", 3, 0.0, "temperature", {7, 8});
  expect_different(common_with("d"), "FAULT there is no particle that both hold");
  std::filesystem::create_directories(folder / "e");
  RunFile(folder / "e", Map(5, 0, world()), PositionView("e", 5), {{{"temperature", "K"}}, {0, 1}, {}}, 0, world());
  expect_different(common_with("e"), "FAULT /time has 3 and 2 frames");
}

TEST(Compare, NanNeverAgrees) {
  TestFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  write_run(folder / "a", 3, nan);
  write_run(folder / "b");
  EXPECT_FALSE(compare(folder / "a/run.h5", folder / "b/run.h5", {1.0, 1e9}).same());
  EXPECT_FALSE(compare(folder / "b/run.h5", folder / "a/run.h5", {1.0, 1e9}).same());
  EXPECT_FALSE(compare(folder / "a/run.h5", folder / "a/run.h5", {1.0, 1e9}).same());
  write_text(folder / "a.csv", "step,a\n0,nan\n");
  EXPECT_FALSE(compare(folder / "a.csv", folder / "a.csv", {1.0, 1e9}).same());
  write_text(folder / "a.json", R"({"a": null, "b": 1})");
  EXPECT_FALSE(compare(folder / "a.json", folder / "a.json", {1.0, 1e9}).same());
}

TEST(Compare, TablesDifferInNumberColumnsAndRows) {
  TestFolder folder;
  write_text(folder / "a.csv", "step,\"probe, 1 [K]\"\n0,300\n1,301\n");
  write_text(folder / "b.csv", "step,\"probe, 1 [K]\"\n0,300\n1,302\n");
  write_text(folder / "c.csv", "step,probe 2 [K]\n0,300\n1,301\n");
  write_text(folder / "d.csv", "step,\"probe, 1 [K]\"\n0,300\n");
  write_text(folder / "e.csv", "step,\"probe, 1 [K]\"\n0,300\n1,hot\n");
  EXPECT_TRUE(compare(folder / "a.csv", folder / "a.csv", {0.0, 0.0}).same());
  expect_different(compare(folder / "a.csv", folder / "b.csv", {1e-3, 0.0}), "line 3, step = 1");
  expect_different(compare(folder / "a.csv", folder / "c.csv", {1.0, 1.0}), "different columns");
  expect_different(compare(folder / "a.csv", folder / "d.csv", {1.0, 1.0}), "has 2 rows");
  expect_different(compare(folder / "a.csv", folder / "e.csv", {1.0, 1.0}), "line 3: 'hot' is no number");
}

TEST(Compare, OfTablesOnlyTheCommonColumns) {
  TestFolder folder;
  write_text(folder / "a.csv", "step,left [K],right [K]\n0,300,310\n1,301,311\n");
  write_text(folder / "b.csv", "step,right [K],deep [K]\n0,310,1\n1,311.5,2\n");
  const auto found = [&](double tolerance) {
    return compare(folder / "a.csv", folder / "b.csv", {tolerance, 0.0, {}, true});
  };
  expect_different(found(1e-3), "DIFFERS right [K]");
  const CompareResult result = found(1e-2);
  EXPECT_TRUE(result.same()) << result.text();
  EXPECT_EQ(result.compared(), 4u);
  for (const char* alone : {"ALONE left [K] is missing in", "ALONE deep [K] is missing in"}) {
    EXPECT_NE(result.text().find(alone), std::string::npos) << result.text();
  }
  write_text(folder / "e.csv", "step,deep [K]\n0,1\n1,2\n");
  expect_different(compare(folder / "a.csv", folder / "e.csv", {1.0, 1.0, {}, true}),
                   "FAULT there is no column that both");
  write_text(folder / "c.csv", "x,x\n1,1\n");
  write_text(folder / "d.csv", "x,x\n1,2\n");
  expect_different(compare(folder / "c.csv", folder / "d.csv", {1e-3, 0.0}), "DIFFERS x");
}

TEST(Compare, JsonDiffersInNumberKeyTypeAndLength) {
  TestFolder folder;
  const auto json = [&](const char* name, const char* text) {
    write_text(folder / name, text);
    return folder / name;
  };
  const std::string gold = json("a.json", R"({"x": {"y": [1, 2.5]}, "wall_s": 3, "name": "a"})");
  EXPECT_TRUE(compare(gold, json("b.json", R"({"x": {"y": [1, 2.5]}, "wall_s": 4, "name": "b"})"), {0.0, 0.0}).same());
  expect_different(compare(gold, json("c.json", R"({"x": {"y": [1, 2.6]}})"), {1e-3, 0.0}), "x.y[1]");
  expect_different(compare(gold, json("d.json", R"({"x": {"y": [1]}, "name": ""})"), {1.0, 1.0}),
                   "has 2 and 1 entries");
  expect_different(compare(gold, json("e.json", R"({"x": {}, "name": ""})"), {1.0, 1.0}),
                   "x.y is missing on the second");
  expect_different(compare(gold, json("f.json", R"({"x": {"y": ["1", 2.5]}, "name": ""})"), {1.0, 1.0}), "x.y[0] is");
  expect_different(compare(gold, json("g.json", "{"), {1.0, 1.0}), "no readable JSON");
}

TEST(Compare, FieldsHaveTolerancesOfTheirOwn) {
  TestFolder folder;
  write_text(folder / "a.csv", "step,hot [K],cold [K],rate\n0,1000,300,0\n");
  write_text(folder / "b.csv", "step,hot [K],cold [K],rate\n0,1001,300.003,1e-9\n");
  const auto compared = [&](const std::vector<FieldTolerance>& own) {
    return compare(folder / "a.csv", folder / "b.csv", {0.0, 0.0, own});
  };
  EXPECT_TRUE(compared({{"hot [K]", 1.1e-3, 0.0}, {"cold [K]", 1.1e-5, 0.0}, {"rate", 1e-6, 1.0}}).same());
  expect_different(compared({{"hot [K]", 1.1e-3, 0.0}, {"rate", 1e-6, 1.0}}), "DIFFERS cold [K]");
  expect_different(compared({{"*[K]", 1.1e-3, 0.0}}), "DIFFERS rate");
  expect_different(compared({{"*[K]", 1.1e-3, 0.0}, {"rate", 1e-6, 0.0}}), "DIFFERS rate");
  EXPECT_TRUE(compared({{"*[K]", 1.1e-3, 0.0}, {"r*e", 1e-6, 1.0}}).same());
  // Of several the first one counts, and one that none is left for is a mistake like one that is misspelt.
  expect_different(compared({{"cold [K]", 1e-6, 0.0}, {"*", 1.0, 1.0}}), "1 beyond 1e-06");
  expect_different(compared({{"*", 1.0, 1.0}, {"hot [K]", 1.0, 1.0}}), "no field is called 'hot [K]'");
  expect_different(compared({{"*", 1.0, 1.0}, {"hto [K]", 1.0, 1.0}}), "no field is called 'hto [K]'");
  EXPECT_THROW(compared({{"*", -1.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(compared({{"*", 1.0, std::nan("")}}), std::invalid_argument);
}

TEST(Compare, ReadsTolerancesOfFields) {
  const FieldTolerance plain = field_tolerance("run.h5:/temperature=1e-8");
  EXPECT_EQ(plain.fields, "run.h5:/temperature");
  EXPECT_EQ(plain.tolerance, 1e-8);
  EXPECT_EQ(plain.floor, 0.0);
  const FieldTolerance floored = field_tolerance("probes.csv:a=b, c [K]=1e-8,300");
  EXPECT_EQ(floored.fields, "probes.csv:a=b, c [K]");
  EXPECT_EQ(floored.tolerance, 1e-8);
  EXPECT_EQ(floored.floor, 300.0);
  for (const char* wrong : {"", "a", "=1", "a=", "a=1x", "a=-1", "a=nan", "a=inf", "a=1,", "a=1,-2", "a=1,2,3"}) {
    EXPECT_THROW(field_tolerance(wrong), InputError) << wrong;
  }
}

TEST(Compare, PatternsOfFields) {
  const auto matches = [](const char* pattern, const char* field) { return FieldTolerance{pattern}.matches(field); };
  EXPECT_TRUE(matches("a.csv:x [m]", "a.csv:x [m]"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("*.csv:*", "a.csv:x [m]"));
  EXPECT_TRUE(matches("*a*a", "banana"));
  EXPECT_FALSE(matches("*a*n", "banana"));
  EXPECT_FALSE(matches("banan", "banana"));
  EXPECT_FALSE(matches("banana", "banan"));
  EXPECT_FALSE(matches("", "a"));
}

TEST(Compare, FilesOfSubfoldersCount) {
  TestFolder folder;
  for (const char* side : {"a", "b"}) {
    std::filesystem::create_directories(folder / side + "/inner");
    write_text(folder / side + "/top.json", R"({"x": 1})");
    write_text(folder / side + "/inner/deep.json", R"({"x": 1})");
  }
  EXPECT_EQ(compare(folder / "a", folder / "b", {0.0, 0.0}).compared(), 2u);
  write_text(folder / "b/inner/deep.json", R"({"x": 2})");
  expect_different(compare(folder / "a", folder / "b", {0.1, 0.0}), "DIFFERS inner/deep.json:x");
  std::filesystem::remove(folder / "b/inner/deep.json");
  expect_different(compare(folder / "a", folder / "b", {0.1, 0.0}), "inner/deep.json is missing in " + (folder / "b"));
}

TEST(Compare, EachFileMustHaveSomethingToCompare) {
  TestFolder folder;
  for (const char* side : {"a", "b"}) {
    std::filesystem::create_directories(folder / side);
    write_text(folder / side + "/full.json", R"({"x": 1})");
    write_text(folder / side + "/empty.csv", "step,a\n");
  }
  expect_different(compare(folder / "a", folder / "b", {0.0, 0.0}),
                   "nothing was compared of " + (folder / "a/empty.csv"));
}

TEST(Compare, RefusesAToleranceThatIsNone) {
  TestFolder folder;
  EXPECT_THROW(compare(folder.path(), folder.path(), {-1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(compare(folder.path(), folder.path(), {std::nan(""), 0.0}), std::invalid_argument);
  EXPECT_THROW(compare(folder.path(), folder.path(), {0.0, HUGE_VAL}), std::invalid_argument);
}

}  // namespace
}  // namespace kiln
