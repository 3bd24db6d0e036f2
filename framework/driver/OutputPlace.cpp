#include "framework/driver/OutputPlace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "framework/files/Together.hpp"

namespace kiln {
namespace {

namespace fs = std::filesystem;

/// Whether `path` is `folder` or below it; both are absolute and normal.
bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool leads_out(const fs::path& path, const fs::path& home) {
  return !is_below(fs::weakly_canonical(home / path), home);
}

/// What is wrong with a folder of results; empty: nothing.
std::string problem_of(const fs::path& folder, const fs::path& home) {
  if (folder.is_absolute()) return fmt::format("{} is an absolute folder", folder.string());
  const fs::path normal = folder.lexically_normal();
  if (!normal.empty() && *normal.begin() == "..") {
    return fmt::format("{} leads out of the current folder", folder.string());
  }
  if (leads_out(folder, home)) {
    return fmt::format("{} leads out of the current folder through a symbolic link", folder.string());
  }
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there)) {
    // A file written through a link to nothing would be made where that link says.
    if (entry.is_symlink() && (!entry.exists() || leads_out(entry.path(), home))) {
      return fmt::format("{} is a symbolic link that leads out of the current folder", entry.path().string());
    }
  }
  return {};
}

}  // namespace

void require_inside(const Input& input, const std::string& key, const std::vector<fs::path>& folders,
                    const Communicator& communicator) {
  if (input.location(key).line == 0) return;
  std::string problem;
  if (communicator.getRank() == 0) {
    try {
      const fs::path home = fs::canonical(fs::current_path());
      for (const fs::path& folder : folders) {
        if (problem.empty()) problem = problem_of(folder, home);
      }
    } catch (const fs::filesystem_error& error) {
      problem = error.what();
    }
  }
  problem = broadcast(communicator, problem);
  if (problem.empty()) return;
  throw input.located(
      InputError(key, problem, "a folder inside the current one, or --set on the command line, or --allow-outside"));
}

}  // namespace kiln
