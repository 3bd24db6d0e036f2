#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln::bench {

using Words = std::vector<std::string>;
using Work = std::function<void(const Words& words, const Teuchos::RCP<const Communicator>& communicator)>;

/// The main function of a program of ./dev bench: MPI and Kokkos, one BLAS thread, `work` on the command line's words,
/// of which there must be one of `counts`; failures told on stderr.
inline int program(int argc, char** argv, const Words& usage, const std::vector<int>& counts, const Work& work) {
  const auto set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(1);
  Tpetra::ScopeGuard guard(&argc, &argv);
  const Words words(argv + 1, argv + argc);
  bool right = false;
  for (const int count : counts) right = right || argc - 1 == count;
  if (!right) {
    fmt::print(stderr, "{}: {} arguments; expected:\n", argv[0], words.size());
    for (const std::string& line : usage) fmt::print(stderr, "  {}\n", line);
    return EXIT_FAILURE;
  }
  try {
    work(words, Tpetra::getDefaultComm());
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

}  // namespace kiln::bench
