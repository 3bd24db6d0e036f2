#include "framework/files/Hdf5.hpp"

#include <gtest/gtest.h>

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Map.hpp>
#include <cmath>
#include <fstream>

#include "framework/base/Error.hpp"
#include "framework/files/RowOrder.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using Ids = std::vector<GlobalIndex>;

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

Teuchos::RCP<const Map> map_of(const Ids& ids) {
  return Teuchos::rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), ids.data(),
                              static_cast<LocalIndex>(ids.size()), 0, world()));
}

/// The ids dealt like cards, each rank's own in descending order: no rank's part is contiguous or sorted.
Ids dealt(const Ids& all) {
  Ids mine;
  for (std::size_t i = all.size(); i-- > 0;) {
    if (static_cast<int>(i) % world()->getSize() == world()->getRank()) mine.push_back(all[i]);
  }
  return mine;
}

double value_of(GlobalIndex id, int column) { return std::sqrt(static_cast<double>(id) + 0.1) + 1000.0 * column; }

MatrixView values_of(const Ids& ids, int columns) {
  MatrixView values("kiln::test::values", ids.size(), columns);
  const auto host = Kokkos::create_mirror_view(values);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (int c = 0; c < columns; ++c) host(i, c) = value_of(ids[i], c);
  }
  Kokkos::deep_copy(values, host);
  return values;
}

template <class Work>
std::string file_error(Work&& work) {
  try {
    work();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

void expect_in(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " not in: " << text;
}

TEST(Hdf5, ReplicatedDataRoundTrips) {
  TestFolder folder;
  const double third = 1.0 / 3.0;
  const std::string long_text(200000, 'k');
  {
    auto file = hdf5::File::create(folder / "a.h5", world());
    auto group = file.create_group("basis");
    group.attribute("name", "Σσ² of 316L");
    group.attribute("empty", "");
    group.attribute("input", long_text);
    group.attribute("third", third);
    group.attribute("count", 9007199254740993LL);
    group.attribute("third", third);
    group.write("sigma", std::vector<double>{3.0, third, -0.0});
    group.write("matrix", hdf5::Array<double>{{2, 3}, {0, 1, 2, 3, 4, 5}});
    group.write("ids", std::vector<long long>{9007199254740993LL, -1});
    group.write("none", std::vector<double>{});
    group.attribute_of("sigma", "unit", "K");
    group.create_group("inner").write("x", std::vector<double>{world()->getRank() + 7.0});
    file.flush();
  }
  const auto file = hdf5::File::read(folder / "a.h5", world());
  const auto group = file.group("basis");
  EXPECT_EQ(group.text("name"), "Σσ² of 316L");
  EXPECT_EQ(group.text("empty"), "");
  EXPECT_EQ(group.text("input"), long_text);
  EXPECT_EQ(group.real("third"), third);
  EXPECT_EQ(group.real("count"), 9007199254740992.0);
  EXPECT_EQ(group.integer("count"), 9007199254740993LL);
  EXPECT_EQ(group.reals("sigma").values, (std::vector<double>{3.0, third, -0.0}));
  EXPECT_TRUE(std::signbit(group.reals("sigma").values[2]));
  EXPECT_EQ(group.reals("matrix", {2, 0}).shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(group.reals("matrix").values, (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(group.integers("ids").values, (std::vector<long long>{9007199254740993LL, -1}));
  EXPECT_TRUE(group.reals("none").values.empty());
  EXPECT_EQ(group.text_of("sigma", "unit"), "K");
  EXPECT_EQ(group.group("inner").path(), "/basis/inner");
  EXPECT_EQ(file.group("basis/inner").reals("x").values[0], 7.0) << "rank 0's value is the one that is written";
  EXPECT_EQ(group.names(), (std::vector<std::string>{"ids", "inner", "matrix", "none", "sigma"}));
  EXPECT_EQ(group.attribute_names(), (std::vector<std::string>{"count", "empty", "input", "name", "third"}));
  EXPECT_TRUE(file.has("basis/inner/x"));
  EXPECT_FALSE(file.has("basis/outer/x"));
  EXPECT_TRUE(group.holds_reals("sigma") && group.holds_integers("ids"));
  EXPECT_FALSE(group.holds_reals("ids") || group.holds_reals("inner") || group.holds_reals("nothing"));
}

TEST(Hdf5, RowsStandInOrderOfIdsWhateverTheRanks) {
  TestFolder folder;
  constexpr int rows = 101, columns = 3;
  Ids all(rows);
  for (int i = 0; i < rows; ++i) all[i] = (i * 37) % rows;
  const Ids mine = dealt(all);
  hdf5::File::create(folder / "rows.h5", world()).write_rows("u", *map_of(mine), values_of(mine, columns));
  const auto file = hdf5::File::read(folder / "rows.h5", world());
  const auto array = file.reals("u", {rows, columns});
  for (int i = 0; i < rows; ++i) {
    for (int c = 0; c < columns; ++c) EXPECT_EQ(array.values[i * columns + c], value_of(i, c));
  }
}

TEST(Hdf5, RowsAreReadToOverlappingMaps) {
  TestFolder folder;
  constexpr int rows = 57, columns = 2;
  Ids all(rows);
  for (int i = 0; i < rows; ++i) all[i] = i;
  const Ids mine = dealt(all);
  {
    auto file = hdf5::File::create(folder / "rows.h5", world());
    file.write_rows("u", *map_of(mine), values_of(mine, columns));
    std::vector<double> single(rows);
    for (int i = 0; i < rows; ++i) single[i] = value_of(i, 5);
    file.write("v", single);
  }
  Ids wanted;
  for (GlobalIndex id = rows - 1; id >= 0; id -= 1 + world()->getRank()) wanted.push_back(id);
  const auto file = hdf5::File::read(folder / "rows.h5", world());
  const auto u = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), file.read_rows("u", *map_of(wanted)));
  const auto v = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), file.read_rows("v", *map_of(wanted)));
  ASSERT_EQ(u.extent(0), wanted.size());
  ASSERT_EQ(u.extent(1), std::size_t{columns});
  ASSERT_EQ(v.extent(1), std::size_t{1});
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(u(i, 0), value_of(wanted[i], 0));
    EXPECT_EQ(u(i, 1), value_of(wanted[i], 1));
    EXPECT_EQ(v(i, 0), value_of(wanted[i], 5));
  }
  const auto everywhere = Tpetra::createLocalMap<LocalIndex, GlobalIndex>(rows, world());
  const auto copy = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), file.read_rows("u", *everywhere));
  ASSERT_EQ(copy.extent(0), std::size_t{rows});
  for (int i = 0; i < rows; ++i) EXPECT_EQ(copy(i, 1), value_of(i, 1));
}

TEST(Hdf5, SparseRowsAreSorted) {
  TestFolder folder;
  const Ids all{50, 7, 1000000, 8, 123};
  const Ids sorted{7, 8, 50, 123, 1000000};
  const Ids mine = dealt(all);
  hdf5::File::create(folder / "rows.h5", world()).write_rows("u", *map_of(mine), values_of(mine, 1));
  const auto values = hdf5::File::read(folder / "rows.h5", world()).reals("u", {5, 1}).values;
  for (std::size_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(values[i], value_of(sorted[i], 0));
  const RowOrder order(*map_of(mine));
  for (std::size_t i = 0; i < order.count(); ++i) {
    EXPECT_EQ(order.ids()[i], static_cast<long long>(sorted[order.first() + i]));
  }
}

TEST(Hdf5, RowsOfAParticleOnTwoRanksAreRefused) {
  if (world()->getSize() == 1) GTEST_SKIP() << "needs two ranks";
  EXPECT_THROW(RowOrder(*map_of({5, 17 + world()->getRank()})), std::logic_error);
  EXPECT_THROW(RowOrder(*map_of({0, 1})), std::logic_error);
}

TEST(Hdf5, BlocksFillADatasetAcrossOpenings) {
  TestFolder folder;
  const auto ranks = static_cast<std::size_t>(world()->getSize());
  const auto rank = static_cast<std::size_t>(world()->getRank());
  {
    auto file = hdf5::File::create(folder / "b.h5", world());
    file.create_reals("u", {3, ranks}, std::nan(""));
    file.create_integers("step", {3}, -1);
    file.write_block("u", {0, rank}, {1, 1}, std::vector<double>{10.0 + rank});
  }
  {
    auto file = hdf5::File::modify(folder / "b.h5", world());
    file.write_block("u", {2, rank}, {1, 1}, std::vector<double>{30.0 + rank});
    const std::size_t count = rank == 0 ? 1 : 0;
    file.write_block("step", {2}, {count}, std::vector<long long>(count, 2));
    EXPECT_EQ(file.read_block("u", {0, 0}, {1, ranks})[rank], 10.0 + rank);
    EXPECT_THROW(file.write_block("u", {3, rank}, {1, 1}, std::vector<double>{0.0}), FileError);
  }
  const auto file = hdf5::File::read(folder / "b.h5", world());
  EXPECT_EQ(file.integers("step").values, (std::vector<long long>{-1, -1, 2}));
  const auto values = file.reals("u").values;
  for (std::size_t r = 0; r < ranks; ++r) {
    EXPECT_EQ(values[r], 10.0 + r);
    EXPECT_TRUE(std::isnan(values[ranks + r]));
    EXPECT_EQ(values[2 * ranks + r], 30.0 + r);
  }
}

TEST(Hdf5, WrongContentsAreNamed) {
  TestFolder folder;
  {
    auto file = hdf5::File::create(folder / "a.h5", world());
    auto group = file.create_group("g");
    group.write("reals", hdf5::Array<double>{{2, 2}, {1, 2, 3, 4}});
    group.write("integers", std::vector<long long>{1});
    group.attribute("text", "a");
    group.attribute("number", 1.5);
  }
  const auto file = hdf5::File::read(folder / "a.h5", world());
  const auto group = file.group("g");
  const std::string name = folder / "a.h5";
  expect_in(file_error([&] { file.group("h"); }), {name, "/h", "is missing"});
  expect_in(file_error([&] { group.group("reals"); }), {name, "/g/reals", "is not a group"});
  expect_in(file_error([&] { group.reals("none"); }), {name, "/g/none", "is missing"});
  expect_in(file_error([&] { file.reals("g"); }), {name, "/g", "no readable dataset"});
  expect_in(file_error([&] { group.reals("integers"); }), {"/g/integers", "holds integers", "floating-point numbers"});
  expect_in(file_error([&] { group.integers("reals"); }), {"/g/reals", "holds floating-point numbers", "integers"});
  expect_in(file_error([&] { group.reals("reals", {2, 3}); }), {"/g/reals", "shape 2 × 2", "expected shape 2 × 3"});
  expect_in(file_error([&] { group.reals("reals", {4}); }), {"/g/reals", "shape 2 × 2", "expected shape 4"});
  expect_in(file_error([&] { group.text("number"); }), {"/g attribute 'number'", "a text"});
  expect_in(file_error([&] { group.real("text"); }), {"/g attribute 'text'", "a number"});
  expect_in(file_error([&] { group.integer("number"); }), {"/g attribute 'number'", "an integer"});
  expect_in(file_error([&] { group.real("none"); }), {"/g attribute 'none'", "is missing"});
  expect_in(file_error([&] { group.text_of("none", "unit"); }), {"/g/none", "is missing"});
  expect_in(file_error([&] { group.read_rows("reals", *map_of({5})); }), {"/g/reals", "has 2 rows", "at least 6"});
}

TEST(Hdf5, DamagedAndMissingFilesAreNamed) {
  TestFolder folder;
  expect_in(file_error([&] { hdf5::File::read(folder / "none.h5", world()); }), {"none.h5", "No such file"});
  expect_in(file_error([&] { hdf5::File::read(folder.path(), world()); }), {folder.path(), "is a folder"});
  expect_in(file_error([&] { hdf5::File::create(folder / "none/a.h5", world()); }), {"none/a.h5", "No such file"});
  { hdf5::File::create(folder / "cut.h5", world()).write("u", std::vector<double>(10000, 1.0)); }
  world()->barrier();
  if (world()->getRank() == 0) {
    std::ofstream(folder / "text.h5") << "step,time\n";
    std::ofstream(folder / "empty.h5");
    std::filesystem::resize_file(folder / "cut.h5", 5000);
  }
  world()->barrier();
  expect_in(file_error([&] { hdf5::File::read(folder / "text.h5", world()); }), {"text.h5", "is not an HDF5 file"});
  expect_in(file_error([&] { hdf5::File::modify(folder / "empty.h5", world()); }), {"empty.h5", "not an HDF5 file"});
  expect_in(file_error([&] { hdf5::File::read(folder / "cut.h5", world()); }), {"cut.h5", "truncated"});
  expect_in(file_error([&] { hdf5::File::modify(folder / "cut.h5", world()); }), {"cut.h5", "truncated"});
}

TEST(Hdf5, EachRankMayHaveAFileOfItsOwn) {
  TestFolder folder;
  const Teuchos::RCP<const Communicator> alone = Teuchos::rcp(new Teuchos::SerialComm<int>());
  const std::string name = folder / ("own-" + std::to_string(world()->getRank()) + ".h5");
  hdf5::File::create(name, alone).attribute("rank", world()->getRank());
  EXPECT_EQ(hdf5::File::read(name, alone).integer("rank"), world()->getRank());
}

}  // namespace
}  // namespace kiln
