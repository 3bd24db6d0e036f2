#include <gtest/gtest.h>

#include <fstream>

#include "framework/base/Error.hpp"
#include "framework/files/CsvColumns.hpp"
#include "framework/files/CsvTable.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

/// As people write tables: a mark of the byte order, comments, blanks, quotes, line ends of another system.
constexpr const char* table =
    "\xEF\xBB\xBF# made by hand\r\n"
    "\r\n"
    " x , \"a \"\"b\"\", c [m]\"\r\n"
    "1, 2.5e-3\r\n"
    "\t\r\n"
    "# later\r\n"
    "-3 ,\"4\"";

TEST(Csv, IsReadAsPeopleWriteIt) {
  const TestFolder folder;
  std::ofstream(folder / "table.csv") << table;
  const CsvTable read = read_csv(folder / "table.csv");
  EXPECT_EQ(read.columns, (std::vector<std::string>{"x", "a \"b\", c [m]"}));
  EXPECT_EQ(read.rows, (std::vector<std::vector<double>>{{1.0, 2.5e-3}, {-3.0, 4.0}}));
}

TEST(Csv, ColumnsAreReadAlike) {
  const TestFolder folder;
  const std::string file = folder / "table.csv";
  std::ofstream(file) << table;
  const CsvColumns read = read_csv_columns(file, {"x"}, {"a \"b\", c [m]"}, *Tpetra::getDefaultComm());
  EXPECT_EQ(read.values, (std::vector<std::vector<double>>{{1.0, -3.0}, {2.5e-3, 4.0}}));
  EXPECT_EQ(read.lines, (std::vector<int>{4, 7}));
}

TEST(Csv, LinesAreCountedWithThoseLeftOut) {
  const TestFolder folder;
  std::ofstream(folder / "table.csv") << "# one\n\nx,y\n1,2\n# two\n3\n";
  try {
    read_csv(folder / "table.csv");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("line 6: has 1 cells"), std::string::npos) << error.what();
  }
}

TEST(Csv, QuotesAmissAreNoNumbers) {
  const TestFolder folder;
  for (const auto& [line, words] : {std::pair{"\"1\"2,3", "line 2: has text behind a closing quote"},
                                    {"\"1,3", "line 2: has a quote that nothing"}}) {
    std::ofstream(folder / "table.csv") << "x,y\n" << line << "\n";
    try {
      read_csv(folder / "table.csv");
      ADD_FAILURE() << line;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

TEST(Csv, OfCommentsAloneIsEmpty) {
  const TestFolder folder;
  std::ofstream(folder / "table.csv") << "# nothing\n";
  EXPECT_THROW(read_csv(folder / "table.csv"), FileError);
}

}  // namespace
}  // namespace kiln
