#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/driver/StudyCases.hpp"
#include "framework/input/Input.hpp"

namespace kiln {

/// The checked inputs of all cases of a study, read once: what is changed in the files later concerns the next start.
class StudyInputs {
 public:
  /// Reads them all; a case may name files that the cases it needs will have written by then. Throws InputError with
  /// the mistakes of all inputs, each once; those of `set:` entries are placed in the study file. Collective.
  StudyInputs(const Input& study, const std::vector<StudyCase>& cases, const std::filesystem::path& working_folder,
              Teuchos::RCP<const Communicator> communicator);

  const Input& of(std::size_t index) const { return inputs_[index]; }

  /// Builds what the given cases would, full order in place of reductions that are not there yet and models that
  /// several cases share once. Throws InputError with all that is wrong. Collective.
  void build(const std::vector<std::size_t>& indices) const;

  /// What a case's results depend on: Kiln's version, ranks, command, merged input but for where results go, contents
  /// of data files, and the needed case's record (CaseRecord::hash; empty: none). Collective.
  nlohmann::json identity(std::size_t index, const std::string& needed_record) const;

  /// Where the case's report.json lies: of its run or of its training.
  std::filesystem::path report_folder(std::size_t index) const;
  /// The files by which one sees that the results are still there.
  std::vector<std::filesystem::path> results(std::size_t index) const;
  /// Command, and type of the method or trainer.
  std::vector<std::string> kind(std::size_t index) const;

 private:
  std::vector<std::string> promised(std::size_t index) const;
  std::vector<Problem> placed(const InputError& error, const StudyCase& item) const;
  std::string location_independent(std::size_t index) const;

  const Input& study_;
  const std::vector<StudyCase>& cases_;
  std::filesystem::path working_folder_;
  Teuchos::RCP<const Communicator> communicator_;
  std::string version_;
  std::vector<Input> inputs_;
};

}  // namespace kiln
