#pragma once

#include <filesystem>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// The folder a run writes into, made when missing and held for this run alone: a second run into it is refused as long
/// as the first one lives, on this machine or another that shares the folder and its locks.
class RunFolder {
 public:
  /// Throws FileError that names the folder when it cannot be made or written, or is held by another run. Writes
  /// nothing but its lock, `run.lock`. Folders that it made and in which nothing was written go with it. Collective.
  RunFolder(const std::filesystem::path& path, const Communicator& communicator);
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  void remove_empty_folders();

  std::vector<std::filesystem::path> made_;  ///< the innermost first
  int lock_ = -1;                            ///< rank 0's descriptor of the locked file
};

}  // namespace kiln
