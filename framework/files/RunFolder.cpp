#include "framework/files/RunFolder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "framework/files/Together.hpp"

namespace kiln {
namespace {

std::string read_owner(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size() - 1, 0);
  return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : "unknown owner";
}

bool write_owner(int descriptor) {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("process {} on {}", ::getpid(), host.data());
  return ::ftruncate(descriptor, 0) == 0 &&
         ::pwrite(descriptor, owner.data(), owner.size(), 0) == static_cast<ssize_t>(owner.size());
}

/// Whether the descriptor still is the file of that name: its last holder may have removed it in between.
bool is_file_of_name(int descriptor, const std::string& name) {
  struct stat held, named;
  return ::fstat(descriptor, &held) == 0 && ::stat(name.c_str(), &named) == 0 && held.st_ino == named.st_ino &&
         held.st_dev == named.st_dev;
}

/// Folders on the way to `path`, itself first, that are not there.
std::vector<std::filesystem::path> missing_folders(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> missing;
  std::error_code ignored;
  for (std::filesystem::path folder = path; !folder.empty() && !std::filesystem::exists(folder, ignored);
       folder = folder.parent_path()) {
    missing.push_back(folder);
    if (folder == folder.parent_path()) break;
  }
  return missing;
}

std::optional<Fault> take(const std::filesystem::path& folder, int& lock) {
  const std::string name = (folder / "run.lock").string();
  while (true) {
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return system_fault("written", errno);
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string owner = read_owner(descriptor);
      ::close(descriptor);
      if (error != EWOULDBLOCK) return system_fault("locked", error);
      return Fault{"", "is in use by another run (" + owner + ")", "a folder of its own for each run"};
    }
    if (!is_file_of_name(descriptor, name)) {
      ::close(descriptor);
      continue;
    }
    if (!write_owner(descriptor)) {
      const int error = errno;
      ::close(descriptor);
      return system_fault("written", error);
    }
    lock = descriptor;
    return std::nullopt;
  }
}

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& path, const Communicator& communicator) : path_(path) {
  on_root(communicator, path_.string(), [this]() -> std::optional<Fault> {
    std::error_code error, ignored;
    made_ = missing_folders(path_);
    std::filesystem::create_directories(path_, error);
    std::optional<Fault> fault;
    if (std::filesystem::is_directory(path_, ignored)) {
      fault = take(path_, lock_);
    } else if (std::filesystem::exists(path_, ignored)) {
      fault = Fault{"", "is not a folder", "a folder for the run's files"};
    } else {
      fault = system_fault("made", error.value());
    }
    if (fault) remove_empty_folders();
    return fault;
  });
}

void RunFolder::remove_empty_folders() {
  std::error_code not_empty;
  // What holds a file stays, and so does what is around it.
  for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, not_empty);
}

RunFolder::~RunFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;
  std::filesystem::remove(path_ / "run.lock", ignored);
  ::close(lock_);
  remove_empty_folders();
}

}  // namespace kiln
