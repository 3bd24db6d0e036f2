#include "framework/driver/Failure.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <Teuchos_DefaultMpiComm.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "framework/base/Error.hpp"
#include "framework/base/ExitStatus.hpp"
#include "framework/base/StopRequest.hpp"

namespace kiln {
namespace {

FailureOutcome outcome_of(std::exception_ptr failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& error) {
    return {exit_bad_input, error.what()};
  } catch (const FileError& error) {
    return {exit_bad_input, error.what()};
  } catch (const NotOffered& error) {
    return {exit_bad_input, error.what()};
  } catch (const DivergenceError& error) {
    return {exit_diverged, error.what()};
  } catch (const Stopped& stopped) {
    return {exit_stopped, stopped.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return {exit_bad_input, fmt::format("{}: {}", error.path1().string(), error.code().message())};
  } catch (const std::bad_alloc&) {
    return {exit_failure, "out of memory"};
  } catch (const std::exception& error) {
    return {exit_failure, fmt::format("an error Kiln did not foresee: {}", error.what())};
  } catch (...) {
    return {exit_failure, "an error Kiln did not foresee, without a message"};
  }
}

/// Whether all ranks arrive here within a few seconds.
bool all_ranks_failed(MPI_Comm communicator) {
  MPI_Request request;
  MPI_Ibarrier(communicator, &request);
  int arrived = 0;
  for (int wait = 0; wait < 500 && arrived == 0; ++wait) {
    MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
    if (arrived == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return arrived != 0;
}

}  // namespace

FailureOutcome settle_failure(std::exception_ptr failure, const Communicator& communicator) {
  FailureOutcome outcome = outcome_of(failure);
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&communicator);
  const bool together = mpi == nullptr || communicator.getSize() == 1 || all_ranks_failed(*mpi->getRawMpiComm());
  if (!together) {
    std::fprintf(stderr, "kiln: rank %d: %s\n", communicator.getRank(), outcome.message.c_str());
    std::fflush(stderr);
    MPI_Abort(*mpi->getRawMpiComm(), outcome.status);
  }
  return outcome;
}

int report_failure(std::exception_ptr failure, const Communicator& communicator) {
  const FailureOutcome outcome = settle_failure(failure, communicator);
  if (communicator.getRank() == 0) std::fprintf(stderr, "%s\n", outcome.message.c_str());
  return outcome.status;
}

}  // namespace kiln
