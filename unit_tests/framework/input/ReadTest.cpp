#include "unit_tests/framework/input/InputTest.hpp"
#include "unit_tests/framework/input/TestComponents.hpp"

namespace kiln::test {
namespace {

class ReadTest : public InputTest {};

const std::string full =
    "output:\n"
    "  point_probes:\n"
    "    points:\n"
    "      - {name: 'true: yes', position: [0.1 mm, 0, 0]}\n"
    "  frames:\n"
    "  directory: out/1\n"
    "time: {iterations: 20, end: 4 ms, step: 4 us}\n"
    "model:\n"
    "  heat_source:\n"
    "    type: gaussian lamp\n"
    "    velocity: [0.5 m/s, 0 m/s]\n"
    "    power: 40 W\n"
    "  spacing: 50 um\n"
    "  kernel: wendland c9\n"
    "  more_sources: [uniform, {type: uniform, conductance: 30 W/m/K}]\n"
    "  tags: [one, 'null', \"a, b\"]\n"
    "  count: [3, +4]\n"
    "  periodic: true\n";

TEST_F(ReadTest, FillsAllKindsOfEntries) {
  const Input input = read_text(full);
  const Teuchos::ParameterList& list = input.list();
  const Teuchos::ParameterList& block = list.sublist("model");
  EXPECT_EQ(list.get<std::string>("title"), "untitled: a run");
  EXPECT_EQ(block.get<double>("spacing"), 5e-5);
  EXPECT_EQ(block.get<double>("temperature"), 293.15);
  EXPECT_EQ(block.get<double>("porosity"), 0.0) << "an integer default of a real";
  EXPECT_EQ(block.get<Teuchos::Array<double>>("origin"), reals({0., 0., 0.5}));
  EXPECT_EQ(block.get<Teuchos::Array<int>>("count"), (Teuchos::Array<int>(std::vector<int>{3, 4})));
  EXPECT_EQ(block.get<Teuchos::Array<std::string>>("tags"),
            (Teuchos::Array<std::string>(Lines{"one", "null", "a, b"})));
  EXPECT_TRUE(block.get<bool>("periodic"));
  EXPECT_FALSE(block.isParameter("table"));
  EXPECT_EQ(block.sublist("kernel").get<std::string>("type"), "wendland c9");
  EXPECT_EQ(block.sublist("kernel").get<double>("radius"), 2);
  EXPECT_EQ(block.sublist("heat_source").sublist("shape").get<std::string>("type"), "wendland c9");
  EXPECT_EQ(block.sublist("more_sources").sublist("0").get<double>("conductance"), 25);
  EXPECT_EQ(block.sublist("more_sources").sublist("1").get<double>("conductance"), 30);
  EXPECT_EQ(list.sublist("time").get<int>("iterations"), 20);
  EXPECT_EQ(list.sublist("time").get<std::string>("jacobian"), "diagonal");
  EXPECT_EQ(list.sublist("output").sublist("frames").get<int>("every"), 1);
  EXPECT_EQ(list.sublist("output").sublist("point_probes").get<std::string>("type"), "point probes");
}

TEST_F(ReadTest, SublistsAreNamedByTheirPath) {
  const Input input = read_text(full);
  const Teuchos::ParameterList& list = input.list();
  EXPECT_EQ(list.name(), "");
  EXPECT_EQ(list.sublist("model").sublist("heat_source").sublist("shape").name(), "model.heat_source.shape");
  const Teuchos::ParameterList& points = list.sublist("output").sublist("point_probes").sublist("points");
  EXPECT_EQ(points.name(), "output.point_probes.points");
  EXPECT_EQ(points.sublist("0").name(), "output.point_probes.points.0");
  EXPECT_EQ(list.sublist("model").sublist("more_sources").sublist("1").name(), "model.more_sources.1");
}

TEST_F(ReadTest, SectionsWithDefaultsMayBeLeftOut) {
  const Input input = read_text(model);
  EXPECT_EQ(input.list().sublist("time").get<double>("step"), 0.1);
  EXPECT_EQ(input.list().sublist("time").name(), "time");
  EXPECT_EQ(input.list().sublist("output").get<std::string>("directory"), "results");
  EXPECT_FALSE(input.list().sublist("output").isSublist("frames"));
  EXPECT_EQ(input.list().sublist("model").sublist("kernel").get<std::string>("type"), "conic spline");
}

TEST_F(ReadTest, CreatesComponents) {
  const Input input = read_text(full);
  const auto kernel = Registry<Kernel>::create(input.list().sublist("model").sublist("kernel"), {});
  EXPECT_EQ(kernel->radius(), 2);
}

TEST_F(ReadTest, LocatesEntriesAndProblems) {
  const Input input = read_text(full);
  EXPECT_EQ(input.file(), "run.yaml");
  EXPECT_EQ(to_string(input.location("model.heat_source.power")), "run.yaml:12:12");
  EXPECT_EQ(to_string(input.location("model.heat_source")), "run.yaml:9:3");
  EXPECT_EQ(to_string(input.location("model.heat_source.width")), "run.yaml:9:3");
  EXPECT_EQ(to_string(input.location("output.point_probes.points.0.position.1")), "run.yaml:4:48");
  EXPECT_EQ(to_string(input.location("model.kernel.type")), "run.yaml:14:11");
  EXPECT_EQ(to_string(input.location("nowhere.at.all")), "run.yaml:1:1");
  const InputError error = input.located(InputError({{"model.spacing", "too fine", "a coarser one", ""},
                                                     {"output.directory", "cannot be written", "", ""},
                                                     {"title", "is dull", "", ""}}));
  EXPECT_STREQ(error.what(),
               "run.yaml:1:1: title: is dull\n"
               "run.yaml:6:14: output.directory: cannot be written\n"
               "run.yaml:13:12: model.spacing: too fine; expected a coarser one");
}

TEST_F(ReadTest, MergedTextIsCanonicalAndReadsBack) {
  const Input input = read_text(full);
  EXPECT_EQ(input.merged(),
            "title: \"untitled: a run\"\n"
            "model:\n"
            "  spacing: 5e-05\n"
            "  temperature: 293.15\n"
            "  porosity: 0\n"
            "  origin: [0, 0, 0.5]\n"
            "  count: [3, 4]\n"
            "  tags: [one, \"null\", \"a, b\"]\n"
            "  periodic: true\n"
            "  kernel:\n"
            "    type: wendland c9\n"
            "    radius: 2\n"
            "  heat_source:\n"
            "    type: gaussian lamp\n"
            "    power: 40\n"
            "    width: 5e-05\n"
            "    velocity: [0.5, 0]\n"
            "    shape:\n"
            "      type: wendland c9\n"
            "      radius: 2\n"
            "  more_sources:\n"
            "    - type: uniform\n"
            "      conductance: 25\n"
            "    - type: uniform\n"
            "      conductance: 30\n"
            "time:\n"
            "  end: 0.004\n"
            "  step: 4e-06\n"
            "  iterations: 20\n"
            "  jacobian: diagonal\n"
            "output:\n"
            "  directory: out/1\n"
            "  frames:\n"
            "    type: frames\n"
            "    every: 1\n"
            "  point_probes:\n"
            "    type: point probes\n"
            "    points:\n"
            "      - name: \"true: yes\"\n"
            "        position: [0.0001, 0, 0]\n");
  EXPECT_EQ(read_text(input.merged()).merged(), input.merged());
  EXPECT_EQ(to_yaml(input.list().sublist("model").sublist("kernel")), "type: wendland c9\nradius: 2\n");
  const Input empty_list = read_text(model + "  more_sources: []\n");
  EXPECT_EQ(read_text(empty_list.merged()).merged(), empty_list.merged());
}

TEST_F(ReadTest, AWrongDefaultIsTheProgrammersMistake) {
  Specification specification;
  specification.integer("count", "of things").defaults_to(1.5);
  write("run.yaml", "{}\n");
  EXPECT_THROW(Input::read("run.yaml", {}, specification, *communicator_), std::logic_error);
}

}  // namespace
}  // namespace kiln::test
