#include "framework/plugin/Plugins.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>

#include "framework/base/Error.hpp"
#include "framework/base/ExitStatus.hpp"
#include "framework/base/Sha256.hpp"
#include "framework/files/Together.hpp"
#include "framework/plugin/Plugin.hpp"
#include "framework/plugin/SharedLibrary.hpp"
#include "framework/registry/Library.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln::plugins {
namespace {

namespace fs = std::filesystem;

struct Store {
  bool forbidden = false;
  std::vector<Loaded> loaded;
};

Store& store() {
  static Store instance;
  return instance;
}

/// Where plugins of this installation lie: beside the Kiln library.
std::optional<fs::path> installed_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&forbid), &info) == 0 || info.dli_fname == nullptr) return std::nullopt;
  std::error_code error;
  const fs::path library = fs::canonical(info.dli_fname, error);
  if (error) return std::nullopt;
  return library.parent_path() / "kiln" / "plugins";
}

/// The absolute paths a plugin of that name may have, in the order of looking.
std::vector<fs::path> candidates(const std::string& name, const fs::path& folder) {
  std::vector<fs::path> paths = {fs::absolute(folder / name).lexically_normal()};
  if (name.find('/') != std::string::npos) return paths;
  const char* const variable = std::getenv("KILN_PLUGIN_PATH");
  std::string rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    // An empty entry would mean the current folder.
    if (end != 0) paths.push_back(fs::absolute(fs::path(rest.substr(0, end)) / name).lexically_normal());
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  if (const auto installed = installed_folder()) paths.push_back(*installed / name);
  return paths;
}

fs::path find(const std::string& name, const fs::path& folder) {
  std::vector<std::string> looked_at;
  for (const fs::path& path : candidates(name, folder)) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) return fs::canonical(path);
    looked_at.push_back(path.string());
  }
  throw FileError(name, "", "there is no such plugin", fmt::format("one of: {}", fmt::join(looked_at, ", ")));
}

std::string read(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw FileError(path, "", "cannot be read");
  return bytes;
}

/// Refuses what is no plugin, or one for another Kiln, by its bytes alone.
void require_same_abi(const std::string& path, const std::string& bytes) {
  const std::string problem = shared_library_problem(bytes);
  if (!problem.empty()) throw FileError(path, "", problem, "a plugin built with kiln_add_plugin");
  const std::string mark = KILN_ABI_MARK;
  const std::size_t at = bytes.find(mark + "Kiln ");
  if (at == std::string::npos) {
    throw FileError(path, "", "is no plugin of Kiln", "a library with KILN_PLUGIN() in one of its sources");
  }
  const std::string tag = bytes.substr(at + mark.size(), bytes.find('\0', at) - at - mark.size());
  if (tag == KILN_ABI) return;
  throw FileError(path, "", fmt::format("was built against {}, and this is {}", tag, KILN_ABI),
                  "a plugin built against this one");
}

std::string dl_message() {
  const char* const message = dlerror();
  return message == nullptr ? "the system does not say why" : message;
}

/// What is being loaded now, for the handler below.
struct Opening {
  std::string path, place;
  int rank = 0;
} opening;

/// The system's loader lets no exception through, so that one of an initialiser of the library ends Kiln: with a
/// message and a status like any other.
[[noreturn]] void end_in_initialiser() {
  std::string why = "without a message";
  try {
    if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {
    // Something else than an exception has nothing to say.
  }
  if (opening.rank == 0) {
    const FileError error(opening.place, opening.path, "cannot be loaded: an initialiser of it fails: " + why);
    std::fprintf(stderr, "%s\n", error.what());
    std::fflush(stderr);
  } else {
    // mpirun ends the other ranks at once when one goes; the first must have spoken.
    std::this_thread::sleep_for(std::chrono::seconds(2));
  }
  std::_Exit(exit_bad_input);
}

/// Lets the system load the library, whose initialisers register its components.
void open(const std::string& path, const std::string& place, int rank) {
  opening = {path, place, rank};
  catalogue::set_library(path);
  const std::terminate_handler handler = std::set_terminate(end_in_initialiser);
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::set_terminate(handler);
  std::string problem;
  if (library == nullptr) {
    problem = "cannot be loaded: " + dl_message();
  } else if (dlsym(library, "kiln_plugin") == nullptr) {
    problem = "does not export what KILN_PLUGIN() defines";
  }
  const std::vector<std::string> clashes = catalogue::end_library(!problem.empty());
  if (!problem.empty()) throw FileError(path, "", problem);
  if (!clashes.empty()) throw FileError(path, "", fmt::format("{}", fmt::join(clashes, "; ")), "names of its own");
}

/// Does `work` on every rank or on rank 0 alone; what any throws is thrown on all, behind the place in the input.
template <class Work>
void together(const Communicator& communicator, const std::string& place, bool on_every_rank, Work&& work) {
  std::optional<Fault> fault;
  if (on_every_rank || communicator.getRank() == 0) {
    try {
      work();
    } catch (const std::exception& error) {
      fault = Fault{"", error.what(), {}};
    }
  }
  throw_together(communicator, place, fault);
}

}  // namespace

void forbid() { store().forbidden = true; }

std::string load(const std::string& name, const fs::path& folder, const std::string& place,
                 const Communicator& communicator) {
  if (store().forbidden) {
    throw InputError(place, fmt::format("the plugin {} is named, and --no-plugins forbids all", name));
  }
  Loaded plugin;
  together(communicator, place, false, [&] {
    plugin.file = find(name, folder).string();
    const std::string bytes = read(plugin.file);
    require_same_abi(plugin.file, bytes);
    plugin.sha256 = sha256_of(bytes);
  });
  plugin.file = broadcast(communicator, plugin.file);
  plugin.sha256 = broadcast(communicator, plugin.sha256);
  std::vector<Loaded>& known = store().loaded;
  const bool is_loaded =
      std::any_of(known.begin(), known.end(), [&](const Loaded& other) { return other.file == plugin.file; });
  if (is_loaded) return plugin.file;
  together(communicator, place, true, [&] {
    if (communicator.getRank() != 0 && sha256_of(read(plugin.file)) != plugin.sha256) {
      throw FileError(plugin.file, "",
                      fmt::format("is another file on rank {} than on rank 0", communicator.getRank()));
    }
    open(plugin.file, place, communicator.getRank());
  });
  known.push_back(plugin);
  return plugin.file;
}

const std::vector<Loaded>& loaded() { return store().loaded; }

}  // namespace kiln::plugins
