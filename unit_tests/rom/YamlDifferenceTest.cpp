#include <gtest/gtest.h>

#include "rom/files/ParticleRows.hpp"
#include "rom/files/YamlDifference.hpp"

namespace kiln {
namespace {

std::string told(const std::string& first, const std::string& second, const std::vector<std::string>& except = {}) {
  std::string text;
  for (const YamlDifference& entry : differences(first, second, "model", except)) {
    text += entry.path + ": " + entry.first + " | " + entry.second + "\n";
  }
  return text;
}

TEST(YamlDifference, NamesEachEntryOnce) {
  const std::string first = "type: sph\nkernel: {type: cubic spline}\nparts: [{a: 1}, {a: 2}]\nsize: [1, 2]\ngone: 5\n";
  const std::string second = "type: sph\nkernel: {type: wendland}\nparts: [{a: 1}, {a: 3}]\nsize: [1, 3]\nnew: 6\n";
  EXPECT_EQ(told(first, first), "");
  EXPECT_EQ(told(first, second),
            "model.kernel.type: cubic spline | wendland\nmodel.parts.1.a: 2 | 3\nmodel.size: [1, 2] | [1, 3]\n"
            "model.gone: 5 | \nmodel.new:  | 6\n");
}

TEST(YamlDifference, LeavesOutLiveParametersAlone) {
  const std::string first = "source: {power: 1, powers: 1, velocity: [1, 0]}\nwidth: 1\n";
  const std::string second = "source: {power: 2, powers: 2, velocity: [2, 0]}\nwidth: 2\n";
  const std::vector<std::string> live{"model.source.power", "model.source.velocity.x", "model.source.velocity.y"};
  EXPECT_EQ(told(first, second, live), "model.source.powers: 1 | 2\nmodel.width: 1 | 2\n");
}

TEST(ParticleRows, UnfoldUndoesFold) {
  MatrixView entries("entries", 6, 2);  // 3 particles × 2 components, 2 columns
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 2; ++k) entries(i, k) = 10 * i + k;
  }
  const MatrixView folded = fold(entries, 2);
  ASSERT_EQ(folded.extent(0), 3u);
  ASSERT_EQ(folded.extent(1), 4u);
  EXPECT_EQ(folded(1, 2 * 1 + 0), entries(2, 1));
  EXPECT_EQ(folded(2, 2 * 0 + 1), entries(5, 0));
  const MatrixView again = unfold(folded, 2);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 2; ++k) EXPECT_EQ(again(i, k), entries(i, k));
  }
}

}  // namespace
}  // namespace kiln
