#pragma once

#include <exception>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// Prints an error once and returns its exit status. Errors are thrown on every rank alike, and rank 0 prints; should
/// one rank fail alone, it prints its own and ends the whole run, so that no rank waits forever.
int report_failure(std::exception_ptr failure, const Communicator& communicator);

}  // namespace kiln
