#include "framework/registry/Describe.hpp"

#include <sstream>

#include "unit_tests/framework/input/InputTest.hpp"
#include "unit_tests/framework/input/TestComponents.hpp"

namespace kiln::test {
namespace {

class DescribeTest : public InputTest {};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The template with a value behind each key that asks for one, by the key.
std::string filled(const std::string& text, const std::map<std::string, std::string>& values) {
  std::string result;
  for (const std::string& line : lines_of(text)) {
    const std::size_t comment = line.find("# required: ");
    if (comment == std::string::npos || line[0] == '#') {
      result += line + "\n";
      continue;
    }
    const std::size_t colon = line.find(':');
    const std::size_t begin = line.find_first_not_of(" -");
    result += line.substr(0, colon + 1) + " " + values.at(line.substr(begin, colon - begin)) + "\n";
  }
  return result;
}

std::string indented(const std::string& text) {
  std::string result;
  for (const std::string& line : lines_of(text)) result += "  " + line + "\n";
  return result;
}

const std::map<std::string, std::string> values = {
    {"spacing", "1 mm"}, {"heat_source", "uniform"}, {"power", "40 W"}, {"name", "a"}, {"position", "[0, 0, 0]"}};

TEST_F(DescribeTest, TellsAllOfAComponent) {
  EXPECT_EQ(describe("gaussian lamp"),
            "gaussian lamp (test source): A moving laser\n"
            "  key       type         unit  default      values\n"
            "  power     number       W     required     above 0                     absorbed power\n"
            "  width     number       m     5e-05        above 0                     standard deviation\n"
            "  velocity  2 numbers    m/s   optional                                 of the lamp\n"
            "  shape     test kernel        wendland c9  conic spline | wendland c9  how it is smoothed\n");
}

TEST_F(DescribeTest, IndentsNestedKeys) {
  EXPECT_EQ(describe("point probes"),
            "point probes (test watcher): Histories at points\n"
            "  key              type            unit  default   values\n"
            "  points           list of blocks        required          the probes\n"
            "    unit_of_value  text                  optional          shown in the file\n"
            "    name           text                  required          of the probe\n"
            "    position       3 numbers       m     required          where it lies\n");
}

TEST_F(DescribeTest, TellsOfCategoriesAndEmptyComponents) {
  EXPECT_EQ(describe("test kernel"),
            "test kernel: a kind of component\n"
            "  conic spline  Piecewise conic\n"
            "  wendland c9   Compactly supported polynomial\n");
  EXPECT_EQ(describe("conic spline").substr(0, describe("conic spline").find("\n\n")),
            "conic spline (test kernel): Piecewise conic\n  no keys\n");
}

TEST_F(DescribeTest, SuggestsNamesAndCategories) {
  const auto message = [](const auto& call) {
    try {
      call();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string start = "there is no component or category ";
  EXPECT_EQ(message([] { describe("gausian lamp"); }),
            start + "'gausian lamp'; expected a name that `kiln list` shows; did you mean 'gaussian lamp'?");
  EXPECT_EQ(message([] { describe("test kernl"); }),
            start + "'test kernl'; expected a name that `kiln list` shows; did you mean 'test kernel'?");
  EXPECT_EQ(message([] { template_of("unifrm"); }),
            "there is no component 'unifrm'; expected a name that `kiln list` shows; did you mean 'uniform'?");
}

TEST_F(DescribeTest, ListsComponents) {
  const std::string list = list_components();
  EXPECT_EQ(list.substr(0, 8), "category");
  for (const Registration* registration : catalogue::all()) {
    EXPECT_NE(list.find(registration->name), std::string::npos);
    EXPECT_NE(list.find(registration->summary), std::string::npos);
  }
  EXPECT_NE(list.find("built in"), std::string::npos);
}

TEST_F(DescribeTest, TemplateHasEveryKey) {
  EXPECT_EQ(template_of("gaussian lamp"),
            "# test source: A moving laser\n"
            "type: gaussian lamp  # test source\n"
            "power:               # required: a power in W above 0; absorbed power\n"
            "width: 5e-05         # standard deviation (m, above 0)\n"
            "# velocity:          # optional: a list of 2 numbers in m/s; of the lamp\n"
            "shape:               # how it is smoothed\n"
            "  type: wendland c9  # a test kernel, one of: conic spline, wendland c9\n"
            "  radius: 2          # support in multiples of h (above 0 and at most 3)\n");
}

TEST_F(DescribeTest, TemplateOfTheRunFilePassesTheChecker) {
  const std::string text = template_of(run_specification(), "a run");
  const Input input = read_text(filled(text, values));
  const Input plain = read_text("model: {spacing: 1 mm, heat_source: uniform}\n");
  EXPECT_EQ(input.merged(), plain.merged()) << text;
}

TEST_F(DescribeTest, TemplatesOfComponentsPassTheChecker) {
  for (const std::string& name : catalogue::names(Source::category)) {
    const std::string text =
        "model:\n  spacing: 1\n  heat_source:\n" + indented(indented(filled(template_of(name), values)));
    EXPECT_EQ(mistakes_of(text), Lines{}) << text;
    EXPECT_EQ(read().list().sublist("model").sublist("heat_source").get<std::string>("type"), name);
  }
  for (const std::string& name : catalogue::names(Watcher::category)) {
    std::string key = name;
    std::replace(key.begin(), key.end(), ' ', '_');
    const std::string text =
        model + "output:\n  " + key + ":\n" + indented(indented(filled(template_of(name), values)));
    EXPECT_EQ(mistakes_of(text), Lines{}) << text;
  }
}

/// What is commented out is right once it is filled in, too.
TEST_F(DescribeTest, CommentedKeysPassTheChecker) {
  std::map<std::string, std::string> more = values;
  more.insert({{"velocity", "[1 m/s, 0]"},
               {"count", "[1, 2]"},
               {"tags", "[a]"},
               {"table", "run.yaml"},
               {"more_sources", "[uniform]"},
               {"unit_of_value", "K"}});
  std::string text;
  for (std::string line : lines_of(template_of(run_specification(), "a run"))) {
    if (line == "# a run") continue;
    if (line.substr(0, 2) == "# ") line.erase(0, 2);
    const std::size_t optional = line.find("# optional: ");
    if (optional != std::string::npos) line.replace(optional, 12, "# required: ");
    text += line + "\n";
  }
  EXPECT_EQ(mistakes_of(filled(text, more)), Lines{}) << text;
  EXPECT_EQ(read().list().sublist("output").sublist("point_probes").sublist("points").numParams(), 1);
}

}  // namespace
}  // namespace kiln::test
