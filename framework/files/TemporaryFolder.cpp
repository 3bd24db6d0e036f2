#include "framework/files/TemporaryFolder.hpp"

#include <cstdlib>
#include <string>

#include "framework/base/Error.hpp"
#include "framework/files/Together.hpp"

namespace kiln {

TemporaryFolder::TemporaryFolder(const Communicator& communicator) : communicator_(communicator) {
  // An unusable TMPDIR throws on all ranks alike.
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  std::string path;
  if (communicator.getRank() == 0) {
    std::string pattern = (folder / "kiln-check-XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path = pattern;
  }
  path_ = broadcast(communicator, path);
  if (path_.empty()) throw FileError(folder.string(), "", "no folder can be made in it");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (communicator_.getRank() == 0) std::filesystem::remove_all(path_, ignored);
}

}  // namespace kiln
