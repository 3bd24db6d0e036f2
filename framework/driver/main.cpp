#include <Tpetra_Core.hpp>

#include <dlfcn.h>

#include <cstdlib>

#include "framework/driver/CommandLine.hpp"

namespace {

/// One BLAS thread a rank unless the environment says otherwise: Kiln's parallelism is its ranks, and a pool of
/// spinning threads costs a reduced step more than its whole arithmetic.
void use_one_blas_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr || std::getenv("OMP_NUM_THREADS") != nullptr) return;
  const auto set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(1);
}

}  // namespace

int main(int argc, char** argv) {
  use_one_blas_thread();
  Tpetra::ScopeGuard scope(&argc, &argv);
  return kiln::command_line(argc, argv, Tpetra::getDefaultComm());
}
