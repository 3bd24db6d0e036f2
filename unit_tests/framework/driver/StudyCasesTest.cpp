#include "framework/driver/StudyCases.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <fstream>

#include "framework/driver/StudySpecification.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

class StudyCasesTest : public testing::Test {
 protected:
  std::vector<StudyCase> expand(const std::string& cases) const {
    const auto communicator = Tpetra::getDefaultComm();
    const std::string file = folder_ / "study.yaml";
    if (communicator->getRank() == 0) std::ofstream(file) << "output: out\ncases:\n" + cases;
    return expand_study(Input::read(file, {}, study_specification(), *communicator), "/some/where");
  }

  /// The mistakes, with the study file's folder left out.
  std::string mistakes(const std::string& cases) const {
    try {
      expand(cases);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_ / "";
      for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
        text.erase(at, prefix.size());
      }
      return text;
    }
    return {};
  }

  static std::vector<std::string> names(const std::vector<StudyCase>& cases) {
    std::vector<std::string> result;
    for (const StudyCase& item : cases) result.push_back(item.name);
    return result;
  }

  TestFolder folder_;
};

TEST_F(StudyCasesTest, ACaseForEachCombination) {
  const auto cases = expand(
      "  - name: part-{part}/{method}-{tolerance}\n"
      "    for: {part: [1, 2], method: [gnat, lspg], tolerance: [1e-3]}\n"
      "    input: part-{part}.yaml\n"
      "    set: {method.type: \"{method}\", time.newton.tolerance: \"{tolerance}\"}\n");
  EXPECT_EQ(names(cases),
            (std::vector<std::string>{"part-1/gnat-1e-3", "part-1/lspg-1e-3", "part-2/gnat-1e-3", "part-2/lspg-1e-3"}));
  const StudyCase& item = cases[1];
  EXPECT_EQ(item.input, folder_ / "part-1.yaml");
  EXPECT_EQ(item.command, "run");
  EXPECT_EQ(item.folder, "out/part-1/lspg-1e-3");
  EXPECT_EQ(item.values, (PlaceholderValues{{"part", "1"}, {"method", "lspg"}, {"tolerance", "1e-3"}}));
  EXPECT_EQ(item.all_overrides(), (std::vector<std::string>{"method.type=lspg", "time.newton.tolerance=1e-3",
                                                            "output.directory=out/part-1/lspg-1e-3"}));
  EXPECT_EQ(item.overrides[1].place, "cases.0.set.time.newton.tolerance");
  EXPECT_FALSE(item.needs.has_value());
}

TEST_F(StudyCasesTest, NeedsFindsTheEarlierCaseAndItsFolder) {
  const auto cases = expand(
      "  - {name: 'basis-{part}', for: {part: [a, b]}, input: i.yaml, command: train}\n"
      "  - name: online-{part}\n"
      "    for: {part: [b, a]}\n"
      "    needs: basis-{part}\n"
      "    input: i.yaml\n"
      "    set: {method.file: '{needs}/reduction.h5'}\n");
  ASSERT_EQ(cases.size(), 4U);
  EXPECT_EQ(cases[0].command, "train");
  EXPECT_EQ(cases[2].needs, 1U);
  EXPECT_EQ(cases[3].needs, 0U);
  EXPECT_EQ(cases[2].overrides[0].text, "method.file=/some/where/out/basis-b/reduction.h5");
}

TEST_F(StudyCasesTest, ListsAreListsOfTheInput) {
  const auto cases = expand(
      "  - {name: a, for: {x: [2 mm]}, input: i.yaml, set: {m.size: ['{x}', 1 mm], m.names: ['a, b', '{x}']}}\n");
  EXPECT_EQ(cases[0].overrides[0].text, "m.size=[2 mm, 1 mm]");
  EXPECT_EQ(cases[0].overrides[1].text, "m.names=[\"a, b\", 2 mm]");
}

TEST_F(StudyCasesTest, AllMistakesAreToldOnceAtTheirPlaces) {
  EXPECT_EQ(mistakes("  - name: a-{x}\n"
                     "    for: {x: [1, 2]}\n"
                     "    input: '{y}.yaml'\n"
                     "    set: {output.directory: b, m.t: '{xx}'}\n"
                     "  - {name: a-1, input: i.yaml, needs: a-3}\n"),
            "study.yaml:5:12: cases.0.input: {y} in '{y}.yaml' has no value; expected one of: x; did you "
            "mean 'x'?\n"
            "study.yaml:6:29: cases.0.set.output.directory: the study sets the case's folder itself; expected the "
            "case's `name`\n"
            "study.yaml:6:37: cases.0.set.m.t: {xx} in '{xx}' has no value; expected one of: x; did you mean 'x'?\n"
            "study.yaml:7:12: cases.1.name: another case is named 'a-1'; expected a name of its own for each case\n"
            "study.yaml:7:39: cases.1.needs: no case before this one is named 'a-3'; expected the name of a case "
            "further up in the file; did you mean 'a-1'?");
}

TEST_F(StudyCasesTest, NamesStayBelowTheStudysFolder) {
  for (const char* name : {"''", "/a", "..", "../a", "a/../../b", "a/", ".", "a//b", "./a"}) {
    EXPECT_NE(mistakes(std::string("  - {name: ") + name + ", input: i.yaml}\n").find("no folder below `output`"),
              std::string::npos)
        << name;
  }
}

TEST_F(StudyCasesTest, ACaseCannotNeedItselfOrALaterOne) {
  const std::string text = mistakes(
      "  - {name: a, input: i.yaml, needs: a}\n"
      "  - {name: b, input: i.yaml, needs: c}\n"
      "  - {name: c, input: i.yaml}\n");
  EXPECT_NE(text.find("cases.0.needs: no case before this one is named 'a'"), std::string::npos) << text;
  EXPECT_NE(text.find("cases.1.needs: no case before this one is named 'c'"), std::string::npos) << text;
}

TEST_F(StudyCasesTest, KeysOfTheFileAreChecked) {
  const std::string text = mistakes(
      "  - {name: a, imput: i.yaml}\n"
      "  - {name: b, input: i.yaml, command: rum}\n"
      "  - {name: c, input: i.yaml, for: {seconds: [1], a.b: [1], c: []}}\n");
  for (const char* part : {"cases.0.imput: unknown key", "did you mean 'input'?", "cases.0.input: missing",
                           "cases.1.command: 'rum' is no choice; expected one of: run, train; did you mean 'run'?",
                           "cases.2.for.seconds: this name has a meaning of its own", "cases.2.for.a.b: a name with",
                           "cases.2.for.c: an empty list is given"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
  }
}

}  // namespace
}  // namespace kiln
