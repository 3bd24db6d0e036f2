#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

class MistakesTest : public InputTest {
 protected:
  struct Case {
    std::string text;
    Lines expected;
  };
  void expect(const std::vector<Case>& cases) const {
    for (const Case& one : cases) EXPECT_EQ(mistakes_of(one.text), one.expected) << one.text;
  }
};

const std::string sources = "gaussian lamp, uniform";

TEST_F(MistakesTest, AreNoneInAGoodFile) { expect({{model, {}}}); }

TEST_F(MistakesTest, UnknownAndDuplicateKeys) {
  expect({
      {model + "tiem: {}\n",
       {"run.yaml:4:1: tiem: unknown key; expected one of: title, model, time, output; did you mean 'time'?"}},
      {model + "time:\n  stepp: 1 s\n  xyzzy: 2\n",
       {"run.yaml:5:3: time.stepp: unknown key; expected one of: end, step, iterations, jacobian; did you mean 'step'?",
        "run.yaml:6:3: time.xyzzy: unknown key; expected one of: end, step, iterations, jacobian"}},
      {model + "  kernel: {type: wendland c9, radus: 2}\n",
       {"run.yaml:4:31: model.kernel.radus: unknown key; expected one of: type, radius; did you mean 'radius'?"}},
      {model + "output:\n  point_probe: {}\n",
       {"run.yaml:5:3: output.point_probe: unknown key; expected one of: directory, frames, point_probes; did you mean "
        "'point_probes'?"}},
      {model + "output: {point_probes: {points: [{name: a, position: [0, 0, 0], colour: red}]}}\n",
       {"run.yaml:4:65: output.point_probes.points.0.colour: unknown key; expected one of: unit_of_value, name, "
        "position"}},
      {model + "time: {step: 1 ms, end: 1, step: 2 ms}\n",
       {"run.yaml:4:28: time.step: duplicate key; expected each key once; it is given at run.yaml:4:8 already"}},
      {model + "model: {}\n",
       {"run.yaml:4:1: model: duplicate key; expected each key once; it is given at run.yaml:1:1 already"}},
      {model + "? [a, b]\n: 1\n", {"run.yaml:4:3: a key that is no text; expected 'key: value'"}},
  });
}

TEST_F(MistakesTest, MissingKeys) {
  expect({
      {"title: nothing else\n",
       {"run.yaml:1:1: model: missing; expected a block with the keys: spacing, temperature, porosity, origin, count, "
        "tags, table, periodic, kernel, heat_source, more_sources"}},
      {"model:\n",
       {"run.yaml:1:1: model.spacing: missing; expected a length in m above 0",
        "run.yaml:1:1: model.heat_source: missing; expected a test source, one of: " + sources}},
      {"title: x\nmodel:\n  spacing: 1\n  heat_source: gaussian lamp\n",
       {"run.yaml:4:16: model.heat_source.power: missing; expected a power in W above 0"}},
      {"model: {spacing: 1, heat_source: {power: 4}}\n",
       {"run.yaml:1:35: model.heat_source: the key 'type' is missing; expected a test source, one of: " + sources}},
      {model + "output: {point_probes: }\n",
       {"run.yaml:4:10: output.point_probes.points: missing; expected a list of blocks with the keys: unit_of_value, "
        "name, position"}},
      {model + "output:\n  point_probes:\n    points:\n      - name: a\n",
       {"run.yaml:7:9: output.point_probes.points.0.position: missing; expected a list of 3 numbers in m"}},
  });
}

TEST_F(MistakesTest, WrongTypes) {
  const std::string end = "run.yaml:4:14: time.end: ";
  const std::string time = "; expected a time in s above 0";
  expect({
      {model + "time: { end: long }\n", {end + "'long' is not a number" + time}},
      {model + "time: { end: [1] }\n", {end + "a list is given" + time}},
      {model + "time: { end: {a: 1} }\n", {"run.yaml:4:9: time.end: a block is given" + time}},
      {model + "time: { end: }\n", {"run.yaml:4:9: time.end: no value is given" + time}},
      {model + "time: { end: '' }\n", {end + "an empty text is given" + time}},
      {model + "time: { end: true }\n", {end + "'true' is not a number" + time}},
      {model + "time: { end: 0x10 }\n", {end + "'0x10' is not a number" + time}},
      {model + "time: { end: '1,5' }\n", {end + "'1,5' is not a number" + time}},
      {model + "time: { end: 1 000 }\n", {end + "'1 000' is not a number" + time}},
      {model + "time: { end: .nan }\n", {end + "'.nan' is not finite" + time}},
      {model + "time: { end: -inf }\n", {end + "'-inf' is not finite" + time}},
      {model + "time: { end: 1e999 }\n", {end + "'1e999' is beyond double precision" + time}},
      {model + "time: 4 s\n",
       {"run.yaml:4:7: time: a single value '4 s' is given; expected a block with the keys: end, step, iterations, "
        "jacobian"}},
      {model + "time: [1, 2]\n",
       {"run.yaml:4:7: time: a list is given; expected a block with the keys: end, step, iterations, jacobian"}},
      {model + "title: [a]\n", {"run.yaml:4:8: title: a list is given; expected a text"}},
      {model + "title:\n", {"run.yaml:4:1: title: no value is given; expected a text"}},
      {model + "  periodic: yes\n",
       {"run.yaml:4:13: model.periodic: 'yes' is not a flag; expected true or false; did you mean 'true'?"}},
      {model + "  periodic: flase\n",
       {"run.yaml:4:13: model.periodic: 'flase' is not a flag; expected true or false; did you mean 'false'?"}},
      {model + "time: {jacobian: diagnal}\n",
       {"run.yaml:4:18: time.jacobian: 'diagnal' is no choice; expected one of: diagonal, sparse; did you mean "
        "'diagonal'?"}},
      {model + "output: {frames: 10}\n",
       {"run.yaml:4:18: output.frames: a single value '10' is given; expected a block of the test watcher 'frames'"}},
      {model + "output: {point_probes: {points: {name: a}}}\n",
       {"run.yaml:4:25: output.point_probes.points: a block is given; expected a list of blocks with the keys: "
        "unit_of_value, name, position"}},
      {model + "output: {point_probes: {points: [a]}}\n",
       {"run.yaml:4:34: output.point_probes.points.0: a single value 'a' is given; expected a list of blocks with the "
        "keys: unit_of_value, name, position"}},
      {model + "output: {point_probes: {points: []}}\n",
       {"run.yaml:4:33: output.point_probes.points: an empty list is given; expected a list of blocks with the keys: "
        "unit_of_value, name, position"}},
  });
}

TEST_F(MistakesTest, Integers) {
  const std::string place = "run.yaml:4:20: time.iterations: ";
  const std::string expected = "; expected an integer from 1 to 100";
  expect({
      {model + "time: {iterations: 1e1}\n", {place + "'1e1' is not an integer" + expected + "; did you mean '10'?"}},
      {model + "time: {iterations: 100.0}\n",
       {place + "'100.0' is not an integer" + expected + "; did you mean '100'?"}},
      {model + "time: {iterations: 4.5}\n", {place + "'4.5' is not an integer" + expected}},
      {model + "time: {iterations: 4 s}\n", {place + "'4 s' is not an integer" + expected}},
      {model + "time: {iterations: ten}\n", {place + "'ten' is not an integer" + expected}},
      {model + "time: {iterations: 3000000000}\n", {place + "'3000000000' is above 2147483647" + expected}},
      {model + "time: {iterations: -3000000000}\n", {place + "'-3000000000' is below -2147483648" + expected}},
      {model + "time: {iterations: 0}\n", {place + "'0' is below 1" + expected}},
      {model + "time: {iterations: 101}\n", {place + "'101' is above 100" + expected}},
  });
}

TEST_F(MistakesTest, RangesAndDimensions) {
  expect({
      {model + "time: {step: -4 us}\n",
       {"run.yaml:4:14: time.step: '-4 us' is not above 0; expected a time in s above 0 and at most 0.5 s"}},
      {model + "time: {step: 600 ms}\n",
       {"run.yaml:4:14: time.step: '600 ms' is above 0.5 s; expected a time in s above 0 and at most 0.5 s"}},
      {model + "  temperature: -300 degC\n",
       {"run.yaml:4:16: model.temperature: '-300 degC' is below 0; expected a temperature in K at least 0"}},
      {model + "  porosity: 101 %\n",
       {"run.yaml:4:13: model.porosity: '101 %' is above 1; expected a number from 0 to 1"}},
      {"model:\n  spacing: 50 W\n  heat_source: uniform\n",
       {"run.yaml:2:12: model.spacing: '50 W' is a power (kg m²/s³); expected a length in m above 0"}},
      {"model:\n  spacing: 50 m^4\n  heat_source: uniform\n",
       {"run.yaml:2:12: model.spacing: '50 m^4' has the dimension m⁴; expected a length in m above 0"}},
      {"model:\n  spacing: 5 %\n  heat_source: uniform\n",
       {"run.yaml:2:12: model.spacing: '5 %' is a pure number; expected a length in m above 0"}},
      {"model:\n  spacing: 50 umm\n  heat_source: uniform\n",
       {"run.yaml:2:12: model.spacing: 'umm' is no unit: there is no 'umm'; expected a length in m above 0; did you "
        "mean 'um'?"}},
      {"model:\n  spacing: 1\n  heat_source: {type: uniform, conductance: 25 W/m K}\n",
       {"run.yaml:3:45: model.heat_source.conductance: 'W/m K' is no unit: a product after '/' is ambiguous; expected "
        "parentheses, as in 'W/(m K)'"}},
      {model + "time: {step: 400 ms, end: 0.3}\n",
       {"run.yaml:4:14: time.step: the step is longer than the run; expected at most 'end'"}},
      {model + "time: {end: 0.05}\n",
       {"run.yaml:4:1: time.step: the step is longer than the run; expected at most 'end'"}},
  });
}

TEST_F(MistakesTest, Lists) {
  expect({
      {model + "  origin: 4 mm\n",
       {"run.yaml:4:11: model.origin: a single value '4 mm' is given; expected a list of 3 numbers in m"}},
      {model + "  origin: [1, 2]\n",
       {"run.yaml:4:11: model.origin: a list of 2 is given; expected a list of 3 numbers in m"}},
      {model + "  origin: [1, two, 3 s]\n",
       {"run.yaml:4:15: model.origin.1: 'two' is not a number; expected a list of 3 numbers in m",
        "run.yaml:4:20: model.origin.2: '3 s' is a time (s); expected a list of 3 numbers in m"}},
      {model + "  origin: [1, [2], 3]\n",
       {"run.yaml:4:15: model.origin.1: a list is given; expected a list of 3 numbers in m"}},
      {model + "  count: [1, 0]\n",
       {"run.yaml:4:14: model.count.1: '0' is below 1; expected a list of 2 integers, each at least 1"}},
      {model + "  tags: alpha\n",
       {"run.yaml:4:9: model.tags: a single value 'alpha' is given; expected a list of texts; did you mean "
        "'[alpha]'?"}},
      {model + "  tags: [alpha, {beta: 1}]\n",
       {"run.yaml:4:17: model.tags.1: a block is given; expected a list of texts"}},
      {model + "  tags: {}\n", {"run.yaml:4:3: model.tags: a block is given; expected a list of texts"}},
  });
}

TEST_F(MistakesTest, Components) {
  expect({
      {model + "  kernel: conic splin\n",
       {"run.yaml:4:11: model.kernel: there is no test kernel 'conic splin'; expected one of: conic spline, wendland "
        "c9; did you mean 'conic spline'?"}},
      {model + "  kernel: {type: Cubic Spline}\n",
       {"run.yaml:4:18: model.kernel.type: there is no test kernel 'Cubic Spline'; expected one of: conic spline, "
        "wendland c9; did you mean 'conic spline'?"}},
      {model + "  kernel: {type: [a]}\n",
       {"run.yaml:4:18: model.kernel.type: a list is given; expected a test kernel, one of: conic spline, wendland "
        "c9"}},
      {model + "  kernel: [a]\n",
       {"run.yaml:4:11: model.kernel: a list is given; expected a test kernel, one of: conic spline, wendland c9"}},
      {model + "  more_sources: uniform\n",
       {"run.yaml:4:17: model.more_sources: a single value 'uniform' is given; expected a list, each item a test "
        "source, one of: " +
        sources}},
      {model + "  more_sources: [uniform, unifrom]\n",
       {"run.yaml:4:27: model.more_sources.1: there is no test source 'unifrom'; expected one of: " + sources +
        "; did you mean 'uniform'?"}},
      {model + "output: {frames: {type: point probes}}\n",
       {"run.yaml:4:25: output.frames.type: a single value 'point probes' is given; expected 'frames', or no type"}},
  });
}

TEST_F(MistakesTest, Files) {
  write("data/other.csv", "1");
  expect({
      {model + "  table: data/steel.csv\n",
       {"run.yaml:4:10: model.table: there is no such file: {folder}/data/steel.csv; expected an existing file"}},
      {model + "  table: data\n",
       {"run.yaml:4:10: model.table: this is a folder: {folder}/data; expected an existing file"}},
      {model + "  table: data/other.csv\n", {}},
  });
}

TEST_F(MistakesTest, OfOneFileAreToldTogetherByPosition) {
  expect(
      {{"title: [no]\n"
        "time:\n"
        "  step: -1\n"
        "  end: 4 W\n"
        "  end: 4\n"
        "output: {frames: {every: 1.0}, extra: 1}\n"
        "model:\n"
        "  heat_source: {type: gaussian bean, power: 40}\n"
        "  kernel: {type: wendland c9, radius: .inf}\n",
        {"run.yaml:1:8: title: a list is given; expected a text",
         "run.yaml:3:9: time.step: '-1' is not above 0; expected a time in s above 0 and at most 0.5 s",
         "run.yaml:4:8: time.end: '4 W' is a power (kg m²/s³); expected a time in s above 0",
         "run.yaml:5:3: time.end: duplicate key; expected each key once; it is given at run.yaml:4:3 already",
         "run.yaml:6:26: output.frames.every: '1.0' is not an integer; expected an integer at least 1; did you mean "
         "'1'?",
         "run.yaml:6:32: output.extra: unknown key; expected one of: directory, frames, point_probes",
         "run.yaml:7:1: model.spacing: missing; expected a length in m above 0",
         "run.yaml:8:23: model.heat_source.type: there is no test source 'gaussian bean'; expected one of: " + sources +
             "; did you mean 'gaussian lamp'?",
         "run.yaml:9:39: model.kernel.radius: '.inf' is not finite; expected a number above 0 and at most 3"}}});
}

}  // namespace
}  // namespace kiln::test
