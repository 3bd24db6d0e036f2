#pragma once

#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/input/Input.hpp"

namespace kiln {

/// What a command gets beside the input file.
struct CommandOptions {
  std::string file;
  std::vector<std::string> overrides;  ///< "path.to.key=value"
  bool restart = false;                ///< continue from the run folder's checkpoint
  bool quiet = false;                  ///< no progress bar, no table
  bool allow_outside = false;          ///< let the input file send results out of the current folder
};

/// `kiln run`: builds what the input names, marches it through its time span and writes the run folder. Throws what
/// went wrong (Error.hpp); a diverged run's report says so. Collective.
void run(const CommandOptions& options, const Teuchos::RCP<const Communicator>& communicator);
/// The same for an input that was read already (run_specification()): of the options it looks at `restart` and `quiet`.
void run(const Input& input, const CommandOptions& options, const Teuchos::RCP<const Communicator>& communicator);

/// `kiln check`: builds everything `kiln run` would, in a temporary folder, and prints the merged input.
void check(const CommandOptions& options, const Teuchos::RCP<const Communicator>& communicator);

/// `kiln train`: carries out the input's `reduction:` block and writes the reduction file and a report. Collective.
void train(const CommandOptions& options, const Teuchos::RCP<const Communicator>& communicator);
void train(const Input& input, const CommandOptions& options, const Teuchos::RCP<const Communicator>& communicator);

/// Builds everything a run of the input needs, in a temporary folder, and its trainer if it `trains`: throws what `kiln
/// run` or `kiln train` would find wrong before the first step. Collective.
void build(const Input& input, bool trains, const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
