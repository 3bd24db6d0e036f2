#pragma once

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Parses the command line, carries the command out and returns the exit status (ExitStatus.hpp). Errors end here:
/// each is printed once and turned into a status. Collective.
int command_line(int argc, char** argv, const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
