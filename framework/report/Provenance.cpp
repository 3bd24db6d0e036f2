#include "framework/report/Provenance.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <Trilinos_version.h>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"

// Any symbol of the BLAS: where it was loaded from says which one it is.
extern "C" void dgemm_();

namespace kiln {
namespace {

namespace build {
#include <BuildFacts.inc>
}

std::string blas_file() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&dgemm_), &info) == 0 || info.dli_fname == nullptr) return "unknown";
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
  return error ? info.dli_fname : file.string();
}

/// What OpenBLAS says of itself; empty when another BLAS is loaded.
std::string openblas_configuration() {
  const auto configuration = reinterpret_cast<char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_config"));
  return configuration == nullptr ? std::string() : configuration();
}

long long openblas_threads() {
  const auto threads = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  return threads == nullptr ? 1 : threads();
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(std::min(line.size(), line.find(':') + 2));
  }
  return "unknown";
}

std::string mpi_library() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string version(text.data(), static_cast<std::size_t>(length));
  return version.substr(0, version.find(','));
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

std::string version_line() { return fmt::format("kiln {} ({}, {})", build::version, build::commit, build::build_type); }

nlohmann::json provenance(const Communicator& communicator) {
  utsname system{};
  ::uname(&system);
  nlohmann::json facts = {
      {"kiln", build::version},
      {"commit", build::commit},
      {"compiler", build::compiler},
      {"build_type", build::build_type},
      {"build_flags", build::flags},
      {"trilinos", TRILINOS_VERSION_STRING},
      {"kokkos", fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100)},
      {"execution_space", ExecutionSpace::name()},
      {"hdf5", hdf5_version()},
      {"mpi", mpi_library()},
      {"blas", blas_file()},
      {"blas_threads", openblas_threads()},
      {"processor", processor()},
      {"cores", static_cast<long long>(::sysconf(_SC_NPROCESSORS_ONLN))},
      {"host", host_name()},
      {"kernel", fmt::format("{} {}", system.sysname, system.release)},
      {"ranks", communicator.getSize()},
      {"date", date()},
  };
  const std::string openblas = openblas_configuration();
  if (!openblas.empty()) facts["openblas"] = openblas;
  return nlohmann::json::parse(broadcast(communicator, json_text(facts)));
}

}  // namespace kiln
