#include <gtest/gtest.h>

#include <fstream>

#include "Chain.hpp"
#include "framework/base/Error.hpp"
#include "framework/input/Input.hpp"
#include "framework/method/Method.hpp"
#include "framework/method/Trainer.hpp"
#include "rom/pod/Truncation.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

/// The block `reduction` and `method` of a YAML text, checked.
Teuchos::ParameterList checked(const std::string& text) {
  const TestFolder folder;
  const std::string file = folder / "input.yaml";
  if (test::world()->getRank() == 0) std::ofstream(file) << text;
  test::world()->barrier();
  Specification s;
  s.component<Trainer>("reduction", "how to train");
  s.component<Method>("method", "which method").defaults_to("gnat");
  try {
    return Input::read(file, {}, s, *test::world()).list();
  } catch (const InputError& error) {
    // Without the folder's name, which is another each time.
    std::string lines;
    for (const Problem& problem : error.problems()) lines += problem.path + ": " + problem.found + "\n";
    throw std::runtime_error(lines);
  }
}

std::string message(const std::string& text) {
  try {
    checked(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(TrainingInput, IsReadAsTheExperimentsWriteIt) {
  const Teuchos::ParameterList list = checked(
      "reduction:\n"
      "  type: procedure ii\n"
      "  basis: {energy: 99.999 %, energy_of: singular values, algorithm: tsqr}\n"
      "  residual_basis: {rank: 60}\n"
      "  sampling: {type: greedy, samples: 120}\n"
      "  queries: [{position: [1 mm, 0 mm, 0.5 mm]}]\n");
  const Teuchos::ParameterList& reduction = list.sublist("reduction");
  const PodSettings basis(reduction.sublist("basis"));
  EXPECT_NEAR(*basis.energy, 0.99999, 1e-15);
  EXPECT_FALSE(basis.rank);
  EXPECT_EQ(basis.algorithm, PodSettings::Algorithm::tsqr);
  EXPECT_EQ(basis.energy_of, PodSettings::EnergyOf::singular_values);
  const PodSettings residual(reduction.sublist("residual_basis"));
  EXPECT_EQ(*residual.rank, 60);
  EXPECT_FALSE(residual.energy);
  EXPECT_EQ(residual.algorithm, PodSettings::Algorithm::gram);
  EXPECT_EQ(residual.path, "reduction.residual_basis");
  EXPECT_EQ(reduction.sublist("snapshots").get<int>("every"), 1);
  EXPECT_EQ(reduction.sublist("sampling").get<int>("samples"), 120);
  EXPECT_DOUBLE_EQ(reduction.sublist("queries").sublist("0").get<Teuchos::Array<double>>("position")[2], 0.5e-3);
}

TEST(TrainingInput, NamesItsMistakes) {
  const std::string text = message(
      "reduction:\n"
      "  type: procedure ii\n"
      "  basis: {rank: 4, energy: 99 %}\n"
      "  residual_basis: {algorithm: gram}\n"
      "  sampling: greedy\n");
  EXPECT_NE(text.find("both rank and energy are given"), std::string::npos) << text;
  EXPECT_NE(text.find("neither rank nor energy is given"), std::string::npos) << text;
  const std::string plain = message(
      "reduction:\n"
      "  type: procedure ii\n"
      "  basis: {energy: 99.9}\n"
      "  residual_basis: {rank: 3}\n");
  EXPECT_NE(plain.find("reduction.basis.energy"), std::string::npos) << plain;
  const std::string few = message(
      "reduction:\n"
      "  type: procedure ii\n"
      "  basis: {rank: 9}\n"
      "  residual_basis: {rank: 8}\n");
  const std::string loose = message(
      "reduction:\n"
      "  type: procedure ii\n"
      "  basis: {rank: 4}\n"
      "  residual_basis: {rank: 4}\n"
      "  clustering: {type: among samples, ridge: 1e-7}\n");
  EXPECT_NE(loose.find("reduction.clustering.ridge: '1e-7' is below 1e-06"), std::string::npos) << loose;
  EXPECT_NE(few.find("8 residual modes do not determine the coordinates of 9 basis vectors"), std::string::npos) << few;
}

}  // namespace
}  // namespace kiln
