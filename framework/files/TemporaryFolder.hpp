#pragma once

#include <filesystem>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A new folder below the system's temporary one, the same on every rank, that goes when its owner goes.
class TemporaryFolder {
 public:
  /// Throws FileError where none can be made. Collective.
  explicit TemporaryFolder(const Communicator& communicator);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  const Communicator& communicator_;
  std::filesystem::path path_;
};

}  // namespace kiln
