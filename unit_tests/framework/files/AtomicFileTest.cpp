#include "framework/files/AtomicFile.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <fstream>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

std::string contents_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::size_t files_in(const TestFolder& folder) {
  world()->barrier();
  const auto count = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  world()->barrier();
  return static_cast<std::size_t>(count);
}

TEST(AtomicFile, ReplacesTextWhole) {
  TestFolder folder;
  write_atomically(folder / "a.txt", "first", world());
  write_atomically(folder / "a.txt", world()->getRank() == 0 ? "second" : "another rank's", world());
  EXPECT_EQ(contents_of(folder / "a.txt"), "second");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, AnUncommittedFileLeavesTheOldOne) {
  TestFolder folder;
  write_atomically(folder / "a.h5", "old", world());
  {
    AtomicPath path(folder / "a.h5", world());
    hdf5::File::create(path.temporary(), world()).attribute("answer", 42);
    EXPECT_EQ(contents_of(folder / "a.h5"), "old");
    world()->barrier();
  }
  EXPECT_EQ(contents_of(folder / "a.h5"), "old");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, ACommittedHdf5FileTakesTheTargetsPlace) {
  TestFolder folder;
  AtomicPath path(folder / "a.h5", world());
  hdf5::File::create(path.temporary(), world()).attribute("answer", 42);
  path.commit();
  EXPECT_EQ(hdf5::File::read(folder / "a.h5", world()).integer("answer"), 42);
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, AMissingFolderIsNamedOnEveryRank) {
  TestFolder folder;
  try {
    write_atomically(folder / "none/a.txt", "text", world());
    FAIL() << "no FileError";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("none/a.txt: cannot be written: No such file"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace kiln
