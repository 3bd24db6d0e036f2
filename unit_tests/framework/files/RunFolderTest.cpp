#include "framework/files/RunFolder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Tpetra_Core.hpp>
#include <fstream>

#include "framework/base/Error.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

std::string error_of(const std::string& path) {
  try {
    const RunFolder folder(path, *world());
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

TEST(RunFolder, IsMadeWithItsParents) {
  TestFolder folder;
  const RunFolder run(folder / "results/2022/one", *world());
  EXPECT_TRUE(std::filesystem::is_directory(run.path()));
}

TEST(RunFolder, RefusesASecondRunWhileTheFirstLives) {
  TestFolder folder;
  {
    const RunFolder first(folder / "run", *world());
    const std::string text = error_of(folder / "run");
    EXPECT_NE(text.find(folder / "run"), std::string::npos) << text;
    EXPECT_NE(text.find("is in use by another run (process "), std::string::npos) << text;
    EXPECT_EQ(error_of(folder / "other"), "no FileError");
  }
  EXPECT_EQ(error_of(folder / "run"), "no FileError");
  world()->barrier();
  EXPECT_FALSE(std::filesystem::exists(folder / "run")) << "a folder in which nothing was written";
}

TEST(RunFolder, TakesTheFoldersItMadeWithItUnlessSomethingWasWritten) {
  TestFolder folder;
  const auto is_there = [&](const char* name) {
    world()->barrier();
    return std::filesystem::exists(folder / name);
  };
  { const RunFolder run(folder / "a/b/c", *world()); }
  EXPECT_FALSE(is_there("a"));
  {
    const RunFolder run(folder / "a/b/c", *world());
    if (world()->getRank() == 0) std::ofstream(folder / "a/kept") << "text";
  }
  EXPECT_FALSE(is_there("a/b"));
  EXPECT_TRUE(is_there("a/kept"));
  { const RunFolder run(folder / "a", *world()); }
  EXPECT_TRUE(is_there("a/kept"));
}

TEST(RunFolder, AKilledRunsLockDoesNotBind) {
  TestFolder folder;
  { const RunFolder made(folder / "run", *world()); }
  if (world()->getRank() == 0) std::ofstream(folder / "run/run.lock") << "process 1 on elsewhere";
  world()->barrier();
  EXPECT_EQ(error_of(folder / "run"), "no FileError");
}

TEST(RunFolder, PlacesThatCannotBeWrittenAreNamed) {
  TestFolder folder;
  if (world()->getRank() == 0) std::ofstream(folder / "file") << "text";
  world()->barrier();
  EXPECT_NE(error_of(folder / "file").find("file: is not a folder; expected a folder"), std::string::npos);
  EXPECT_NE(error_of(folder / "file/run").find("file/run: cannot be made: Not a directory"), std::string::npos);
  // Not even root may write there.
  EXPECT_NE(error_of("/proc/sys").find("/proc/sys: cannot be written"), std::string::npos);
  EXPECT_NE(error_of("/proc/kiln").find("/proc/kiln: cannot be made"), std::string::npos);
}

}  // namespace
}  // namespace kiln
