#include "framework/files/AtomicFile.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <utility>

#include "framework/files/Together.hpp"

namespace kiln {
namespace {

/// 0, or the error number.
int synchronise(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  // Some file systems cannot synchronise folders; the rename itself stands nonetheless.
  const int error = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  ::close(descriptor);
  return error;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

}  // namespace

AtomicPath::AtomicPath(std::filesystem::path target, Teuchos::RCP<const Communicator> communicator)
    : target_(std::move(target)), temporary_(target_.string() + ".partial"), communicator_(std::move(communicator)) {}

AtomicPath::~AtomicPath() {
  if (!committed_ && communicator_->getRank() == 0) std::remove(temporary_.c_str());
}

void AtomicPath::commit() { commit(true); }
void AtomicPath::commit_unsynchronised() { commit(false); }

void AtomicPath::commit(bool synchronised) {
  communicator_->barrier();
  on_root(*communicator_, target_.string(), [&]() -> std::optional<Fault> {
    const auto disk = [synchronised](const std::filesystem::path& path, int flags) {
      return synchronised ? synchronise(path, flags) : 0;
    };
    if (const int error = disk(temporary_, O_RDONLY)) return system_fault("written", error);
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return system_fault("written", errno);
    if (const int error = disk(folder_of(target_), O_RDONLY | O_DIRECTORY)) return system_fault("written", error);
    return std::nullopt;
  });
  committed_ = true;
}

void write_atomically(const std::filesystem::path& target, const std::string& text,
                      const Teuchos::RCP<const Communicator>& communicator, bool synchronised) {
  AtomicPath path(target, communicator);
  on_root(*communicator, target.string(), [&]() -> std::optional<Fault> {
    errno = 0;
    std::ofstream file(path.temporary(), std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) return system_fault("written", errno);
    return std::nullopt;
  });
  if (synchronised) {
    path.commit();
  } else {
    path.commit_unsynchronised();
  }
}

}  // namespace kiln
