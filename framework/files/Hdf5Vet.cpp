#include "framework/files/Hdf5Vet.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

#include "framework/files/Hdf5Node.hpp"

namespace kiln::hdf5 {
namespace {

constexpr std::chrono::seconds patience(4);
constexpr rlim_t memory = rlim_t{768} << 20;
/// Decompressed data that is read on trial.
constexpr hsize_t most_values = hsize_t{1} << 24;

/// The first fault on a walk through a file.
struct Walk {
  std::string place;
  std::string found;
};

herr_t refuse(Walk& walk, const char* name, const std::string& found) {
  walk.place = std::string("/") + name;
  walk.found = found;
  return 1;
}

bool leads_elsewhere(hid_t properties) {
  if (H5Pget_layout(properties) != H5D_VIRTUAL) return H5Pget_external_count(properties) > 0;
  std::size_t sources = 0;
  H5Pget_virtual_count(properties, &sources);
  for (std::size_t i = 0; i < sources; ++i) {
    char name[8] = {};
    // "." is the file itself.
    if (H5Pget_virtual_filename(properties, i, name, sizeof name) != 1 || name[0] != '.') return true;
  }
  return false;
}

/// Reads a chunked dataset whole: its index and its filters may be damaged.
bool chunks_are_readable(hid_t dataset, hid_t space, hid_t properties) {
  if (H5Pget_layout(properties) != H5D_CHUNKED) return true;
  const hssize_t values = H5Sget_simple_extent_npoints(space);
  if (values <= 0 || static_cast<hsize_t>(values) > most_values) return true;
  const Id type(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) return true;
  std::vector<double> read(static_cast<std::size_t>(values));
  return H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()) >= 0;
}

herr_t visit_attribute(hid_t object, const char* name, const H5A_info_t*, void*) {
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Id type(H5Aget_type(attribute), H5Tclose);
  const Id space(H5Aget_space(attribute), H5Sclose);
  const hssize_t values = H5Sget_simple_extent_npoints(space);
  const std::size_t size = H5Tget_size(type);
  if (!attribute.valid() || values < 0 || size == 0) return -1;
  std::vector<char> bytes(static_cast<std::size_t>(values) * size);
  if (bytes.empty()) return 0;
  const bool read = H5Aread(attribute, type, bytes.data()) >= 0;
  if (read && H5Tdetect_class(type, H5T_VLEN) > 0) H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes.data());
  return read ? 0 : -1;
}

herr_t visit_object(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  Walk& walk = *static_cast<Walk*>(data);
  const Id object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
  hsize_t first = 0;
  if (!object.valid() || H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, &first, visit_attribute, nullptr) < 0) {
    return refuse(walk, name, "cannot be read" + reason());
  }
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Id space(H5Dget_space(object), H5Sclose);
  const Id properties(H5Dget_create_plist(object), H5Pclose);
  if (!space.valid() || !properties.valid()) return refuse(walk, name, "cannot be read" + reason());
  if (leads_elsewhere(properties)) return refuse(walk, name, "takes its values from another file");
  H5Dget_storage_size(object);
  if (!chunks_are_readable(object, space, properties)) return refuse(walk, name, "cannot be read" + reason());
  return 0;
}

herr_t visit_link(hid_t, const char* name, const H5L_info_t* info, void* data) {
  if (info->type == H5L_TYPE_HARD || info->type == H5L_TYPE_SOFT) return 0;
  return refuse(*static_cast<Walk*>(data), name, "leads to another file");
}

/// "place\nwhat is wrong"; empty: nothing.
std::string walked(const std::string& path) {
  Walk walk;
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  const Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (!file.valid()) return "\ncannot be read" + reason();
  const herr_t links = H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit_link, &walk);
  if (links < 0) return "/\ncannot be read" + reason();
  if (links == 0 && H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit_object, &walk, H5O_INFO_BASIC) < 0) {
    return "/\ncannot be read" + reason();
  }
  return walk.found.empty() ? "" : walk.place + "\n" + walk.found;
}

void limit(decltype(RLIMIT_CORE) resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

rlim_t address_space() {
  long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void be_the_child(const std::string& path, int out) {
  // MPI's and a sanitizer's handlers would print what is no news to a user.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
#if !defined(__SANITIZE_ADDRESS__)
  limit(RLIMIT_AS, address_space() + memory);
#endif
  std::string problem;
  try {
    problem = walked(path);
  } catch (const std::exception&) {
    problem = "\ndeclares more data than it can hold";
  }
  const std::string message = "done" + problem;
  const bool told = ::write(out, message.data(), message.size()) == static_cast<ssize_t>(message.size());
  _exit(told ? 0 : 1);
}

/// What the child says until it ends or patience does.
std::string listen(int in) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  std::string message;
  char part[4096];
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waiting{in, POLLIN, 0};
    const int ready = left.count() <= 0 ? 0 : ::poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return "done\ntakes too long to read";
    const ssize_t length = ::read(in, part, sizeof part);
    if (length < 0 && errno == EINTR) continue;
    if (length <= 0) return message;
    message.append(part, static_cast<std::size_t>(length));
  }
}

}  // namespace

std::optional<Fault> vet(const std::string& path) {
  int ends[2];
  if (::pipe(ends) != 0) return system_fault("read", errno);
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    return system_fault("read", error);
  }
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(path, ends[1]);
  }
  ::close(ends[1]);
  const std::string message = listen(ends[0]);
  ::close(ends[0]);
  ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (message == "done") return std::nullopt;
  if (message.rfind("done", 0) != 0) return Fault{"", "is damaged: HDF5 cannot get through it", "an intact HDF5 file"};
  const std::size_t line = message.find('\n');
  return Fault{message.substr(4, line - 4), message.substr(line + 1), {}};
}

}  // namespace kiln::hdf5
