#pragma once

#include <Teuchos_Array.hpp>
#include <Tpetra_Core.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "framework/input/Input.hpp"
#include "framework/model/Model.hpp"
#include "framework/registry/Specification.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

/// What tests of any physics need.
namespace kiln {

inline Teuchos::Array<double> reals(std::vector<double> values) { return Teuchos::Array<double>(values); }

/// A communicator of this rank alone.
inline Teuchos::RCP<const Communicator> alone() {
  const auto everyone = Tpetra::getDefaultComm();
  const int rank = everyone->getRank();
  return everyone->createSubcommunicator(Teuchos::ArrayView<const int>(&rank, 1));
}

/// The block `model` of a YAML text, through the checker, with one line replaced. Throws InputError.
inline Teuchos::ParameterList checked_model(std::string text, const std::string& line, const std::string& replacement) {
  text.replace(text.find(line), line.size(), replacement);
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  if (everyone->getRank() == 0) std::ofstream(folder / "case.yaml") << text;
  everyone->barrier();
  Specification specification;
  specification.component<Model>("model", "the model");
  return Input::read(folder / "case.yaml", {}, specification, *everyone).list().sublist("model");
}

}  // namespace kiln
