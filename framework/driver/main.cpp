#include <Tpetra_Core.hpp>

#include "framework/driver/CommandLine.hpp"

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  return kiln::command_line(argc, argv, Tpetra::getDefaultComm());
}
