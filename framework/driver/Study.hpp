#pragma once

#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

struct StudyOptions {
  std::string file;
  std::vector<std::string> overrides;  ///< of the study file's entries, "path.to.key=value"
  std::vector<std::string> only;       ///< shell patterns of case names, with what those cases need; none: all
  bool quiet = false;                  ///< no progress; failures are told nonetheless
  bool allow_outside = false;          ///< let the study file send results out of the current folder
};

/// `kiln study`: runs the cases of a study file (study_specification()) one after the other on all ranks. What an
/// earlier start completed and nothing changed since is kept; an interrupted case goes on from its checkpoint; failed
/// cases are tried again. A case that fails is recorded, those that need it are skipped, the rest goes on. Beside the
/// cases' folders lies study.json: a list of all cases with placeholders, status, seconds and message.
///
/// Throws InputError with all mistakes of the study and of all its inputs before the first case runs, and FileError for
/// a folder that another study holds. Returns the exit status: success if all selected cases are complete. Collective.
int study(const StudyOptions& options, const Teuchos::RCP<const Communicator>& communicator);

/// `kiln study --list`: the matrix as a table with each case's state; changes nothing. Collective.
std::string list_study(const StudyOptions& options, const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
