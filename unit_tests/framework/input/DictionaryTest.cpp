#include "unit_tests/framework/input/InputTest.hpp"

namespace kiln::test {
namespace {

/// A block whose keys the user chooses.
class DictionaryTest : public InputTest {
 protected:
  static Specification specification() {
    Specification s;
    s.dictionary("set", "what to change").optional();
    s.text("title", "a line").defaults_to("");
    return s;
  }
  Input read_set(const std::string& text) const {
    write("run.yaml", text);
    return Input::read("run.yaml", {}, specification(), *communicator_);
  }
  std::string message(const std::string& text) const {
    try {
      read_set(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(DictionaryTest, KeepsTextsAndListsInTheirOrder) {
  const Input input = read_set("set: {z.b: 1e-3, a: [x, 2 mm], m: '{power}'}\n");
  const Teuchos::ParameterList& set = input.list().sublist("set");
  std::vector<std::string> keys;
  for (auto entry = set.begin(); entry != set.end(); ++entry) keys.push_back(set.name(entry));
  EXPECT_EQ(keys, (std::vector<std::string>{"z.b", "a", "m"}));
  EXPECT_EQ(set.get<std::string>("z.b"), "1e-3");
  EXPECT_EQ(set.get<Teuchos::Array<std::string>>("a").toVector(), (std::vector<std::string>{"x", "2 mm"}));
  EXPECT_EQ(set.get<std::string>("m"), "{power}");
  EXPECT_EQ(to_string(input.location("set.a")), "run.yaml:1:21");
}

TEST_F(DictionaryTest, IsReadBackFromTheMergedInput) {
  const std::string merged = read_set("set: {a.b: '{x}', c: [1, 'y: z']}\n").merged();
  EXPECT_EQ(read_set(merged).merged(), merged);
}

TEST_F(DictionaryTest, MayBeEmptyOrLeftOut) {
  EXPECT_EQ(read_set("set:\n").list().sublist("set").numParams(), 0);
  EXPECT_FALSE(read_set("title: x\n").list().isSublist("set"));
}

TEST_F(DictionaryTest, RefusesWhatIsNoText) {
  EXPECT_EQ(message("set: 3\n"),
            "run.yaml:1:6: set: a single value '3' is given; expected a block of keys, each with a text or a list of "
            "texts");
  EXPECT_EQ(message("set:\n  a: {b: c}\n  d: [[1]]\n"),
            "run.yaml:2:3: set.a: a block is given; expected a text or a list of texts\n"
            "run.yaml:3:7: set.d.0: a list is given; expected a list of texts");
  EXPECT_EQ(message("set: {a: }\n"), "run.yaml:1:7: set.a: no value is given; expected a text or a list of texts");
}

TEST_F(DictionaryTest, SuggestsQuotesAroundAPlaceholder) {
  EXPECT_EQ(message("set: {a: {power}}\n"),
            "run.yaml:1:7: set.a: a block is given; expected a text or a list of texts; did you mean '\"{power}\"'?");
}

}  // namespace
}  // namespace kiln::test
