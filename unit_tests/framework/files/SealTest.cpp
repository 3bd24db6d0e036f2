#include "framework/files/Seal.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <fstream>
#include <functional>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

std::string file_error(const std::function<void()>& work) {
  try {
    work();
  } catch (const FileError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A sealed file with a small dataset and one that is large.
class Seal : public testing::Test {
 protected:
  Seal() : name_(folder_ / "sealed.h5") {
    {
      hdf5::File file = hdf5::File::create(name_, world());
      file.attribute("answer", 42);
      file.write("small", std::vector<double>{1.0, 2.0, 3.0});
      file.write("large", std::vector<double>(200000, 0.5));
      file.flush();
    }
    hdf5::seal(name_, *world());
  }

  std::size_t size() const {
    world()->barrier();
    return std::filesystem::file_size(name_);
  }

  /// Changes the byte on rank 0.
  void change(std::size_t place, int mask = 1) const {
    world()->barrier();
    if (world()->getRank() == 0) {
      std::fstream file(name_, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(place));
      const int byte = file.get();
      file.seekp(static_cast<std::streamoff>(place));
      file.put(static_cast<char>(byte ^ mask));
    }
    world()->barrier();
  }

  hdf5::Segment large_segment() const {
    for (const hdf5::Segment& segment : hdf5::read_seal(name_, false)) {
      if (segment.large) return segment;
    }
    ADD_FAILURE() << "no large segment";
    return {};
  }

  TestFolder folder_;
  std::string name_;
};

TEST_F(Seal, ASealedFileIsReadAsBefore) {
  const hdf5::File file = hdf5::File::read(name_, world());
  file.require_seal();
  EXPECT_EQ(file.integer("answer"), 42);
  EXPECT_EQ(file.reals("small").values, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(file.reals("large").values, std::vector<double>(200000, 0.5));
  EXPECT_EQ(large_segment().length, 200000 * sizeof(double));
}

TEST_F(Seal, SealingAgainChangesNothing) {
  const std::size_t before = size();
  hdf5::seal(name_, *world());
  EXPECT_EQ(size(), before);
  EXPECT_EQ(hdf5::File::read(name_, world()).integer("answer"), 42);
}

TEST_F(Seal, AChangeTakesTheSealAway) {
  {
    hdf5::File file = hdf5::File::modify(name_, world());
    file.attribute("answer", 43);
    file.flush();
  }
  const auto told = file_error([&] { hdf5::File::read(name_, world()).require_seal(); });
  EXPECT_EQ(told.rfind(name_ + ": ", 0), 0u) << told;
  hdf5::seal(name_, *world());
  const hdf5::File again = hdf5::File::read(name_, world());
  again.require_seal();
  EXPECT_EQ(again.integer("answer"), 43);
}

TEST_F(Seal, AFlippedBitIsNoticedWhenTheFileIsOpened) {
  const hdf5::Segment large = large_segment();
  for (const std::size_t place :
       {std::size_t{50}, std::size_t{700}, std::size_t(large.offset - 1), std::size_t(large.offset + large.length)}) {
    if (place >= size()) continue;
    change(place);
    const std::string told = file_error([&] { hdf5::File::read(name_, world()); });
    EXPECT_EQ(told.rfind(name_ + ": ", 0), 0u) << told;
    EXPECT_NE(told.find("is damaged: it is not what was written; expected the file as Kiln wrote it"),
              std::string::npos)
        << place << ": " << told;
    change(place);
  }
}

TEST_F(Seal, AFlippedBitOfALargeDatasetIsNoticedWhenItIsRead) {
  const hdf5::Segment large = large_segment();
  change(large.offset + large.length / 2);
  const hdf5::File file = hdf5::File::read(name_, world());
  EXPECT_EQ(file.reals("small").values.size(), 3u);
  const std::string expected =
      name_ + ": /large: is damaged: it is not what was written; expected the file as Kiln wrote it";
  EXPECT_EQ(file_error([&] { file.reals("large"); }), expected);
  EXPECT_EQ(file_error([&] { file.read_block("large", {0}, {10}); }), expected);
}

TEST_F(Seal, AFlippedBitOfTheSealIsNoticed) {
  const std::size_t end = size();
  // From the marks on, each byte; the marks' own make it no seal.
  for (std::size_t place = end - 40; place < end; place += 3) {
    change(place, 0x20);
    const std::string told = file_error([&] { hdf5::File::read(name_, world()).require_seal(); });
    EXPECT_EQ(told.rfind(name_ + ": ", 0), 0u) << place << ": " << told;
    change(place, 0x20);
  }
}

TEST_F(Seal, AnUnsealedFileHasNone) {
  const std::string name = folder_ / "plain.h5";
  hdf5::File::create(name, world()).attribute("answer", 1);
  const hdf5::File file = hdf5::File::read(name, world());
  EXPECT_EQ(file.integer("answer"), 1);
  EXPECT_EQ(
      file_error([&] { file.require_seal(); }),
      name +
          ": carries no seal: it was cut short, changed, or written by another version of Kiln; expected the file as "
          "this version of Kiln wrote it");
}

}  // namespace
}  // namespace kiln
