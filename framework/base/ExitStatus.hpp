#pragma once

namespace kiln {

/// Exit statuses of the command line.
enum ExitStatus : int {
  exit_success = 0,
  exit_failure = 1,    ///< a comparison that differs, a study with failed cases, or an error Kiln did not foresee
  exit_bad_input = 2,  ///< input, data file or command line: the message names the place
  exit_diverged = 3,   ///< a solve diverged or became non-finite; the last good checkpoint is kept
  exit_stopped = 4     ///< SIGTERM or SIGINT came; a checkpoint of the last step is there if the input asks for any
};

}  // namespace kiln
