#include "framework/base/Hash.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "framework/base/Error.hpp"
#include "framework/base/Sha256.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

TEST(Hash, IsXxh3WithItsPublishedValues) {
  // The values of xxHash's reference implementation for the empty input and for "a".
  EXPECT_EQ(hash_of(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(hash_of("a"), "a96faf705af16834e6c632b61e964e1f");
  EXPECT_NE(hash_of("power: 40 W"), hash_of("power: 41 W"));
}

TEST(Sha256, IsThatOfFips180) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Hash, OfAFileIsThatOfItsBytes) {
  TestFolder folder;
  const std::string bytes(3 * (std::size_t{1} << 20) + 17, 'x');
  std::ofstream(folder / "a", std::ios::binary) << bytes;
  EXPECT_EQ(hash_of_file(folder / "a"), hash_of(bytes));
  EXPECT_THROW(hash_of_file(folder / "none"), FileError);
  EXPECT_THROW(hash_of_file(folder.path()), FileError);
}

}  // namespace
}  // namespace kiln
