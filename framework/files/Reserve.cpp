#include "framework/files/Reserve.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <optional>

#include "framework/files/Together.hpp"

namespace kiln::hdf5 {
namespace {

bool failed = false;

/// File systems that cannot set aside are left alone.
std::optional<Fault> set_aside(const std::string& path, std::uint64_t bytes, int flags, int mode) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (descriptor < 0) return system_fault("written", errno);
  const bool done = bytes == 0 || ::fallocate(descriptor, mode, 0, static_cast<off_t>(bytes)) == 0;
  const int error = errno;
  ::close(descriptor);
  if (done || error == EOPNOTSUPP || error == ENOSYS || error == EINVAL) return std::nullopt;
  return system_fault("written", error);
}

}  // namespace

File create_with_room(const std::string& path, std::uint64_t bytes,
                      const Teuchos::RCP<const Communicator>& communicator) {
  on_root(*communicator, path, [&]() -> std::optional<Fault> {
    std::optional<Fault> fault = set_aside(path, bytes, O_CREAT | O_TRUNC, 0);
    if (fault) std::remove(path.c_str());
    return fault;
  });
  File file = File::create(path, communicator);
  // HDF5 began by making the file empty, and its length must stay what HDF5 thinks.
  on_root(*communicator, path, [&] { return set_aside(path, bytes, 0, FALLOC_FL_KEEP_SIZE); });
  return file;
}

bool writing_failed() { return failed; }
void note_failed_writing() { failed = true; }

}  // namespace kiln::hdf5
