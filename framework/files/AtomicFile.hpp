#pragma once

#include <filesystem>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// A file that appears whole or not at all: it is written at `temporary()`, beside its target, and takes the target's
/// place in one step. What stood there before survives until then, and a program that is killed leaves it as it was.
///
///     AtomicPath path("reduction.h5", communicator);
///     { auto file = hdf5::File::create(path.temporary(), communicator); …; file.flush(); }
///     path.commit();
class AtomicPath {
 public:
  AtomicPath(std::filesystem::path target, Teuchos::RCP<const Communicator> communicator);
  AtomicPath(const AtomicPath&) = delete;
  AtomicPath& operator=(const AtomicPath&) = delete;
  /// Removes the temporary file unless it was committed.
  ~AtomicPath();

  const std::string& temporary() const { return temporary_; }
  /// Brings the closed temporary file to disk, renames it and brings the folder to disk. Throws FileError. Collective.
  void commit();
  /// Renames only: whole or not at all when the program is killed, but not when the machine loses power; for small
  /// files that are written often and easily made again.
  void commit_unsynchronised();

 private:
  void commit(bool synchronised);

  std::filesystem::path target_;
  std::string temporary_;
  Teuchos::RCP<const Communicator> communicator_;
  bool committed_ = false;
};

/// Writes rank 0's text to a file that appears whole or not at all; `synchronised` as AtomicPath's two ways to commit.
/// Throws FileError. Collective.
void write_atomically(const std::filesystem::path& target, const std::string& text,
                      const Teuchos::RCP<const Communicator>& communicator, bool synchronised = true);

}  // namespace kiln
