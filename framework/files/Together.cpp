#include "framework/files/Together.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <cstring>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"

namespace kiln {
namespace {

std::string broadcast_from(const Communicator& communicator, int root, std::string text) {
  broadcast(communicator, root, text);
  return text;
}

}  // namespace

void throw_together(const Communicator& communicator, const std::string& file, const std::optional<Fault>& fault) {
  const int ranks = communicator.getSize();
  const int mine = fault ? communicator.getRank() : ranks;
  int first = ranks;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &mine, &first);
  if (first == ranks) return;
  const Fault own = fault.value_or(Fault{});
  const std::string place = broadcast_from(communicator, first, own.place);
  const std::string found = broadcast_from(communicator, first, own.found);
  const std::string expected = broadcast_from(communicator, first, own.expected);
  throw FileError(file, place, found, expected);
}

void on_root(const Communicator& communicator, const std::string& file,
             const std::function<std::optional<Fault>()>& work) {
  std::optional<Fault> fault;
  if (communicator.getRank() == 0) {
    try {
      fault = work();
    } catch (const std::exception& error) {
      const std::string text = error.what(), name = file + ": ";
      // A FileError names the file already.
      fault = Fault{"", text.compare(0, name.size(), name) == 0 ? text.substr(name.size()) : text, ""};
    }
  }
  throw_together(communicator, file, fault);
}

std::string broadcast(const Communicator& communicator, const std::string& text) {
  return broadcast_from(communicator, 0, text);
}

Fault system_fault(const std::string& done, int error_number) {
  return {"", "cannot be " + done + ": " + std::strerror(error_number), ""};
}

}  // namespace kiln
