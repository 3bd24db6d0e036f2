#include "unit_tests/fuzz/Harness.hpp"

#include <unistd.h>

#include <Tpetra_Core.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "framework/base/Error.hpp"

namespace kiln::fuzz {
namespace {

/// The folder of this process, on a file system in memory where there is one.
class Folder {
 public:
  Folder() {
    const bool in_memory = std::filesystem::is_directory("/dev/shm");
    path_ = std::filesystem::path(in_memory ? "/dev/shm" : "/tmp") / ("kiln-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const Folder& folder() {
  static const Folder instance;
  return instance;
}

}  // namespace

void initialise() {
  static int count = 1;
  static char name[] = "fuzz";
  static char* names[] = {name, nullptr};
  static char** arguments = names;
  if (!Tpetra::isInitialized()) Tpetra::initialize(&count, &arguments);
}

Teuchos::RCP<const Communicator> alone() { return Tpetra::getDefaultComm(); }

std::string sound(const std::string& name) {
  const char* const place = std::getenv("KILN_FUZZ_SOUND");
  if (place == nullptr) found("KILN_FUZZ_SOUND is not set: ./dev fuzz sets it");
  return std::string(place) + "/" + name;
}

std::string scratch(const std::string& name) { return (folder().path() / name).string(); }

void write(const std::string& path, const std::uint8_t* data, std::size_t size) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
}

std::string read(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

void found(const std::string& what) {
  std::fprintf(stderr, "FOUND: %s\n", what.c_str());
  std::abort();
}

void refuses_or_does(const std::function<void()>& work) {
  const auto told = [](const std::exception& error) {
    if (*error.what() == '\0') found("an error without a message");
  };
  try {
    work();
  } catch (const InputError& error) {
    told(error);
  } catch (const FileError& error) {
    told(error);
  } catch (const NotOffered& error) {
    told(error);
  } catch (const DivergenceError& error) {
    told(error);
  } catch (const std::exception& error) {
    found(std::string("an error Kiln did not foresee: ") + error.what());
  }
}

}  // namespace kiln::fuzz
