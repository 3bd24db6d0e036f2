#include <Tpetra_Core.hpp>

#include <dlfcn.h>

#include <mpi.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "framework/driver/CommandLine.hpp"
#include "framework/files/Reserve.hpp"

namespace {

/// One BLAS thread a rank unless the environment says otherwise: Kiln's parallelism is its ranks, and a pool of
/// spinning threads costs a reduced step more than its whole arithmetic.
void use_one_blas_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr || std::getenv("OMP_NUM_THREADS") != nullptr) return;
  const auto set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(1);
}

/// Without HDF5's farewell.
[[noreturn]] void leave_at_once(int status) {
  std::fflush(nullptr);
  if (Tpetra::getDefaultComm()->getSize() > 1) MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

}  // namespace

int main(int argc, char** argv) {
  use_one_blas_thread();
  // A limit on a file's size is told like a full disk, not by the signal's death.
  std::signal(SIGXFSZ, SIG_IGN);
  // The command line is Kiln's alone: Kokkos would answer --help with its own page and take unprefixed flags of its
  // own. Its settings come from KOKKOS_… environment variables.
  int library_argc = 1;
  char* library_arguments[] = {argv[0], nullptr};
  char** library_argv = library_arguments;
  Tpetra::ScopeGuard scope(&library_argc, &library_argv);
  const int status = kiln::command_line(argc, argv, Tpetra::getDefaultComm());
  if (kiln::hdf5::writing_failed()) leave_at_once(status);
  return status;
}
