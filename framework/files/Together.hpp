#pragma once

#include <functional>
#include <optional>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

/// Work on files that one rank does and all answer for: no rank is left waiting when another one fails.
namespace kiln {

/// What is wrong with a file, before it becomes a FileError: the parts of its message after the file's name.
struct Fault {
  std::string place;     ///< a dataset, an attribute, a line, or empty
  std::string found;     ///< what is wrong
  std::string expected;  ///< may be empty
};

/// Throws the same FileError on every rank if any rank brings a fault: the one of the lowest such rank. Collective.
void throw_together(const Communicator& communicator, const std::string& file, const std::optional<Fault>& fault);

/// Runs `work` on rank 0 alone; a fault it returns is thrown as FileError on every rank. Collective.
void on_root(const Communicator& communicator, const std::string& file,
             const std::function<std::optional<Fault>()>& work);

/// Rank 0's text on every rank. Collective.
std::string broadcast(const Communicator& communicator, const std::string& text);

/// What errno says, e.g. "Permission denied", in the words "cannot be `done`: Permission denied".
Fault system_fault(const std::string& done, int error_number);

}  // namespace kiln
