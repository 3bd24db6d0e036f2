#include "framework/files/Hdf5Vet.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <Tpetra_Core.hpp>
#include <chrono>
#include <fstream>
#include <functional>
#include <sstream>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

std::string told(const std::string& path) {
  const std::optional<Fault> fault = hdf5::vet(path);
  return fault ? fault->place + ": " + fault->found : "";
}

/// A file made through HDF5 itself, on rank 0.
void make(const std::string& path, const std::function<void(hid_t)>& fill) {
  world()->barrier();
  if (world()->getRank() == 0) {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    fill(file);
    H5Fclose(file);
  }
  world()->barrier();
}

void make_dataset(hid_t file, const char* name, hid_t properties) {
  const hsize_t extent = 4;
  const hid_t space = H5Screate_simple(1, &extent, nullptr);
  H5Dclose(H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Sclose(space);
}

TEST(Vet, ASoundFilePasses) {
  TestFolder folder;
  {
    hdf5::File file = hdf5::File::create(folder / "a.h5", world());
    file.attribute("text", "a");
    hdf5::Group group = file.create_group("g");
    group.write("reals", hdf5::Array<double>{{2, 2}, {1, 2, 3, 4}});
    group.create_row_views("/g/reals");
    file.link("again", "/g/reals");
    file.flush();
  }
  EXPECT_EQ(told(folder / "a.h5"), "");
}

TEST(Vet, LinksToOtherFilesAreRefused) {
  TestFolder folder;
  make(folder / "link.h5",
       [](hid_t file) { H5Lcreate_external("other.h5", "/x", file, "x", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_EQ(told(folder / "link.h5"), "/x: leads to another file");
  make(folder / "values.h5", [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(properties, "/etc/passwd", 0, H5F_UNLIMITED);
    make_dataset(file, "x", properties);
    H5Pclose(properties);
  });
  EXPECT_EQ(told(folder / "values.h5"), "/x: takes its values from another file");
  make(folder / "virtual.h5", [](hid_t file) {
    const hsize_t extent = 4;
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &extent, nullptr);
    H5Pset_virtual(properties, space, "other.h5", "/x", space);
    make_dataset(file, "x", properties);
    H5Sclose(space);
    H5Pclose(properties);
  });
  EXPECT_EQ(told(folder / "virtual.h5"), "/x: takes its values from another file");
  try {
    hdf5::File::read(folder / "link.h5", world());
    FAIL() << "taken";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()), (folder / "link.h5") + ": /x: leads to another file");
  }
}

TEST(Vet, DeclaredButNotThere) {
  TestFolder folder;
  make(folder / "a.h5", [](hid_t file) {
    const hsize_t extent = hsize_t{1} << 40, chunk = 16;
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &extent, nullptr);
    H5Pset_chunk(properties, 1, &chunk);
    H5Dclose(H5Dcreate2(file, "chunked", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
    H5Dclose(H5Dcreate2(file, "plain", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(properties);
  });
  const hdf5::File file = hdf5::File::read(folder / "a.h5", world());
  for (const char* name : {"chunked", "plain"}) {
    try {
      file.reals(name);
      FAIL() << "taken";
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()),
                (folder / "a.h5") + ": /" + name +
                    ": has shape 1099511627776; expected values for all of it: there are 0 bytes");
    }
  }
}

/// No byte of a file's first pages can make HDF5 end this program or keep it for long.
TEST(Vet, DamagedMetadataEndsInAnAnswer) {
  TestFolder folder;
  {
    hdf5::File file = hdf5::File::create(folder / "sound.h5", world());
    for (int i = 0; i < 6; ++i) file.create_group("group " + std::to_string(i)).attribute("text", "words");
    file.write("reals", std::vector<double>(100, 1.0));
    file.flush();
  }
  world()->barrier();
  if (world()->getRank() != 0) return;
  std::ostringstream text;
  text << std::ifstream(folder / "sound.h5", std::ios::binary).rdbuf();
  const std::string sound = text.str();
  int refused = 0;
  for (std::size_t place = 8; place < std::min<std::size_t>(sound.size(), 4000); place += 53) {
    std::string bytes = sound;
    bytes[place] = static_cast<char>(bytes[place] ^ 0xff);
    std::ofstream(folder / "broken.h5", std::ios::binary) << bytes;
    const auto start = std::chrono::steady_clock::now();
    refused += told(folder / "broken.h5").empty() ? 0 : 1;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << place;
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace kiln
