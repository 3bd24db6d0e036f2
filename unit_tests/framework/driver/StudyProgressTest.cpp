#include "framework/driver/StudyProgress.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace kiln {
namespace {

TEST(CaseTimes, TakeTheMeanOfTheMostAlike) {
  CaseTimes times;
  EXPECT_FALSE(times.expected({"run", "fom"}).has_value());
  times.add({"run", "fom"}, 10.0);
  EXPECT_EQ(times.expected({"run", "fom"}), 10.0);
  EXPECT_EQ(times.expected({"train", "procedure ii"}), 10.0);
  times.add({"run", "gnat"}, 1.0);
  times.add({"run", "gnat"}, 3.0);
  times.add({"train", "procedure ii"}, 66.0);
  EXPECT_EQ(times.expected({"run", "fom"}), 10.0);
  EXPECT_EQ(times.expected({"run", "gnat"}), 2.0);
  EXPECT_EQ(times.expected({"run", "lspg"}), 14.0 / 3.0);
  EXPECT_EQ(times.expected({"other", ""}), 20.0);
}

class StudyProgressTest : public testing::Test {
 protected:
  StudyProgressTest() : stream_(open_memstream(&text_, &size_)) {}
  ~StudyProgressTest() override {
    std::fclose(stream_);
    std::free(text_);
  }
  std::string written() {
    std::fflush(stream_);
    return std::string(text_, size_);
  }
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

TEST_F(StudyProgressTest, IsALineACase) {
  StudyProgress progress({"a", "longer", "c", "d", "e", "f", "g", "h", "i", "j"}, stream_, false);
  progress.begin(0, std::nullopt);
  progress.end(0, 0.163, "done", 754.0);
  progress.begin(1, 3.0);
  progress.end(1, 19.52, "failed: why", std::nullopt);
  progress.end(9, std::nullopt, "skipped: needs a (failed)", 0.0);
  EXPECT_EQ(written(),
            "[ 1/10] a        0.16 s  done, 12:34 left\n"
            "[ 2/10] longer   19.5 s  failed: why\n"
            "[10/10] j                skipped: needs a (failed), 0 s left\n");
}

TEST_F(StudyProgressTest, ATerminalShowsTheCaseThatRuns) {
  StudyProgress progress({"a"}, stream_, true);
  progress.begin(0, 2.0);
  progress.end(0, 125.0, "done", 0.0);
  EXPECT_EQ(written(), "\r[1/1] a           running, 2 s left\x1b[K\r\x1b[K[1/1] a     2:05  done, 0 s left\n");
}

TEST(StudyProgress, IsSilentWithoutAStream) {
  StudyProgress progress({"a"}, nullptr, true);
  progress.begin(0, 2.0);
  progress.end(0, 125.0, "done", 0.0);
}

}  // namespace
}  // namespace kiln
