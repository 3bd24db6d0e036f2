#include <gtest/gtest.h>

#include <fstream>

#include "framework/base/Error.hpp"
#include "framework/queries/QueryPoints.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

class QueryPoints : public testing::Test {
 protected:
  QueryPoints() {
    parameters_.add("beam.power", "W", &power_, Allowed::not_negative);
    parameters_.add("beam.width", "m", &width_, Allowed::positive);
    parameters_.add("beam.velocity.x", "m/s", &velocity_);
    parameters_.add("share", "1", &share_);
    list_.set("grid", false).set("together", 16);
  }
  void points(const std::vector<std::pair<std::string, std::vector<std::string>>>& values) {
    Teuchos::ParameterList& list = list_.sublist("points");
    list.setName("queries.points");
    for (const auto& [name, texts] : values) list.set(name, Teuchos::Array<std::string>(texts));
  }
  ParameterPoints table(const std::string& text) {
    std::ofstream(folder_ / "points.csv") << text;
    list_.set("file", folder_ / "points.csv");
    return points_of(list_, parameters_);
  }
  std::vector<Problem> problems() {
    try {
      points_of(list_, parameters_);
    } catch (const InputError& error) {
      return error.problems();
    }
    return {};
  }
  std::string table_error(const std::string& text) {
    try {
      table(text);
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  }

  TestFolder folder_;
  double power_ = 1.0, width_ = 4.0, velocity_ = 2.0, share_ = 3.0;
  Parameters parameters_;
  Teuchos::ParameterList list_;
};

using Values = std::vector<std::vector<double>>;

TEST_F(QueryPoints, AreTheRowsOfListsInSiUnits) {
  points({{"beam.velocity.x", {"0.5 m/s", "450 mm/s"}}, {"beam.power", {"36 W", "0.04 kW"}}, {"share", {"1", "20 %"}}});
  const ParameterPoints points = points_of(list_, parameters_);
  EXPECT_EQ(points.names, (std::vector<std::string>{"beam.velocity.x", "beam.power", "share"}));
  EXPECT_EQ(points.values, (Values{{0.5, 36.0, 1.0}, {0.45, 40.0, 0.2}}));
  points.set(1, parameters_);
  EXPECT_EQ(power_, 40.0);
  EXPECT_EQ(velocity_, 0.45);
}

TEST_F(QueryPoints, OfAGridAreAllCombinationsTheLastFastest) {
  points({{"beam.power", {"1", "2"}}, {"share", {"3", "4", "5"}}});
  list_.set("grid", true);
  EXPECT_EQ(points_of(list_, parameters_).values, (Values{{1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}}));
}

TEST_F(QueryPoints, AreTheRowsOfATable) {
  const ParameterPoints points = table("share,beam.velocity.x [mm/s]\n1,450\n0.5,5e2\n");
  EXPECT_EQ(points.names, (std::vector<std::string>{"share", "beam.velocity.x"}));
  EXPECT_EQ(points.values, (Values{{1.0, 0.45}, {0.5, 0.5}}));
}

TEST_F(QueryPoints, TellAllMistakesOfListsAtOnce) {
  points(
      {{"beam.power", {"36 W", "40 m", "nan"}}, {"beam.powr", {"1"}}, {"share", {"1", "2"}}, {"beam.velocity.x", {}}});
  const std::vector<Problem> found = problems();
  ASSERT_EQ(found.size(), 6u);
  EXPECT_EQ(found[0].found, "'40 m' is a length");
  EXPECT_EQ(found[0].expected, "a power in W at least 0");
  EXPECT_EQ(found[1].found, "'nan' is not finite");
  EXPECT_EQ(found[2].path, "queries.points.beam.powr");
  EXPECT_EQ(found[2].suggestion, "beam.power");
  EXPECT_EQ(found[3].found, "lists 2 values");
  EXPECT_EQ(found[4].found, "an empty list is given");
  EXPECT_EQ(found[5].found, "lists 0 values");
}

TEST_F(QueryPoints, TakeNoValueThatTheInputWouldRefuse) {
  points({{"beam.power", {"0 W", "-1 W"}}, {"beam.width", {"0 m", "1 um"}}});
  const std::vector<Problem> found = problems();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].found, "'-1 W' is below 0");
  EXPECT_EQ(found[0].expected, "a power in W at least 0");
  EXPECT_EQ(found[1].found, "'0 m' is not above 0");
  EXPECT_EQ(found[1].expected, "a length in m above 0");
}

TEST_F(QueryPoints, TellWhatIsWrongWithATable) {
  EXPECT_NE(table_error("beam.width [um]\n1\n0\n").find("point 1, beam.width: '0 um' is not above 0"),
            std::string::npos);
  EXPECT_NE(table_error("beam.powr\n1\n").find("the model has no live parameter 'beam.powr'"), std::string::npos);
  EXPECT_NE(table_error("share,beam.power [m]\n1,1\n").find("column 2: beam.power [m] is a length"), std::string::npos);
  EXPECT_NE(table_error("beam.power [Wx]\n1\n").find("column 1"), std::string::npos);
  EXPECT_NE(table_error("share,share\n1,1\n").find("an earlier column's name"), std::string::npos);
  EXPECT_NE(table_error("share\n").find("has no row"), std::string::npos);
  EXPECT_NE(table_error("share\nx\n").find("line 2"), std::string::npos);
  EXPECT_NE(table_error("share\n1\nnan\n").find("point 1, share"), std::string::npos);
  EXPECT_NE(table_error("share,beam.power\n1\n").find("has 1 cells"), std::string::npos);
}

}  // namespace
}  // namespace kiln
