#pragma once

#include <exception>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// What a caught error comes to: the exit status (ExitStatus.hpp) and the message.
struct FailureOutcome {
  int status;
  std::string message;
};

/// Of an error that every rank throws alike; should one rank fail alone, it prints its own and ends the whole run, so
/// that no rank waits forever. Collective.
FailureOutcome settle_failure(std::exception_ptr failure, const Communicator& communicator);

/// Prints an error once and returns its exit status, as settle_failure() does. Collective.
int report_failure(std::exception_ptr failure, const Communicator& communicator);

}  // namespace kiln
