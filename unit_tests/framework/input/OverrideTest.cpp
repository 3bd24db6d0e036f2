#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

class OverrideTest : public InputTest {};

const std::string probes = "output: {point_probes: {points: [{name: a, position: [0, 0, 0]}]}}\n";

TEST_F(OverrideTest, SetsValuesBlocksAndItems) {
  const Input input = read_text(
      model + probes, {"title=a = b", "model.heat_source.power=50 W", "model.origin=[1 mm, 2, 3]", "model.origin.2=4",
                       "output.point_probes.points.0.name=first",
                       "output.point_probes.points.1={name: b, position: [1, 1, 1]}", "output.frames={every: 3}",
                       "time.step=1 ms", "time.step=2 ms", "model.kernel=wendland c9", "model.kernel.radius=3"});
  const Teuchos::ParameterList& list = input.list();
  EXPECT_EQ(list.get<std::string>("title"), "a = b");
  EXPECT_EQ(list.sublist("model").sublist("heat_source").get<double>("power"), 50);
  EXPECT_EQ(list.sublist("model").get<Teuchos::Array<double>>("origin"), reals({1e-3, 2., 4.}));
  const Teuchos::ParameterList& points = list.sublist("output").sublist("point_probes").sublist("points");
  EXPECT_EQ(points.sublist("0").get<std::string>("name"), "first");
  EXPECT_EQ(points.sublist("1").get<std::string>("name"), "b");
  EXPECT_EQ(list.sublist("output").sublist("frames").get<int>("every"), 3);
  EXPECT_EQ(list.sublist("time").get<double>("step"), 2e-3) << "the last one wins";
  EXPECT_EQ(list.sublist("model").sublist("kernel").get<double>("radius"), 3);
  EXPECT_EQ(to_string(input.location("time.step")), "--set time.step=2 ms");
  EXPECT_EQ(to_string(input.location("output.point_probes.points.0.position")), "run.yaml:4:54");
}

TEST_F(OverrideTest, MendsTheFile) {
  EXPECT_EQ(mistakes_of(model + "time: {step: -1}\n").size(), 1u);
  EXPECT_EQ(mistakes_of(model + "time: {step: -1}\n", {"time.step=1 ms"}), Lines{});
}

TEST_F(OverrideTest, APathIsNoDeeperThanAFile) {
  std::string path = "a";
  for (int i = 0; i < 64; ++i) path += ".a";
  const Lines told = mistakes_of(model, {path + "=1"});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told.front().substr(0, 10), "--set a.a.");
  EXPECT_NE(told.front().find(": a path of 65 keys; expected at most 64"), std::string::npos) << told.front();
}

TEST_F(OverrideTest, FilesLieBesideTheInput) {
  write("sub/steel.csv", "1");
  write("sub/run.yaml", model);
  EXPECT_EQ(mistakes({"model.table=steel.csv"}, "sub/run.yaml"), Lines{});
  EXPECT_EQ(mistakes({"model.table=lead.csv"}, "sub/run.yaml"),
            Lines{"--set model.table=lead.csv: model.table: there is no such file: {folder}/sub/lead.csv; expected an "
                  "existing file"});
}

TEST_F(OverrideTest, MistakesNameTheOverrideAfterThoseOfTheFile) {
  struct Case {
    std::string text;
    std::string expected;
  };
  const std::vector<Case> cases = {
      {"model.powr=3",
       "model.powr: unknown key; expected one of: spacing, temperature, porosity, origin, count, tags, table, "
       "periodic, "
       "kernel, heat_source, more_sources"},
      {"time.step=-1", "time.step: '-1' is not above 0; expected a time in s above 0 and at most 0.5 s"},
      {"time.step=", "time.step: no value is given; expected a time in s above 0 and at most 0.5 s"},
      {"time.step", "no '='; expected path.to.key=value"},
      {"time..step=1", "an empty key; expected path.to.key=value"},
      {"=1", "an empty key; expected path.to.key=value"},
      {"time.step=[1", "a list opened by '[' is not closed; expected ',' or ']'"},
      {"time=4", "time: a single value '4' is given; expected a block with the keys: end, step, iterations, jacobian"},
      {"time.end.x=4", "time.end: a block is given; expected a time in s above 0"},
      {"output.point_probes.points.2.name=x",
       "output.point_probes.points.2: the list has no item '2'; expected a number from 0 to 1"},
      {"output.point_probes.points.first.name=x",
       "output.point_probes.points.first: the list has no item 'first'; expected a number from 0 to 1"},
      {"output.point_probes.points.99999999999.name=x",
       "output.point_probes.points.99999999999: the list has no item '99999999999'; expected a number from 0 to 1"},
      {"time={step: 1 ms, step: 2 ms}", "step: duplicate key; expected each key once"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(mistakes_of(model + probes, {one.text}), Lines{"--set " + one.text + ": " + one.expected});
  }
  EXPECT_EQ(mistakes_of("title: []\n" + model, {"time.end=0"}),
            (Lines{"run.yaml:1:8: title: a list is given; expected a text",
                   "--set time.end=0: time.end: '0' is not above 0; expected a time in s above 0"}));
}

}  // namespace
}  // namespace kiln::test
