#pragma once

#include <unistd.h>

#include <Tpetra_Core.hpp>
#include <filesystem>
#include <string>

#include "framework/files/Together.hpp"

namespace kiln {

/// A folder for one test's files, the same on every rank, removed at the end.
class TestFolder {
 public:
  TestFolder() : communicator_(Tpetra::getDefaultComm()) {
    std::string pattern = (std::filesystem::temp_directory_path() / "kiln-test-XXXXXX").string();
    if (communicator_->getRank() == 0 && mkdtemp(pattern.data()) == nullptr) pattern.clear();
    folder_ = broadcast(*communicator_, pattern);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    communicator_->barrier();
    std::error_code ignored;
    if (communicator_->getRank() == 0) std::filesystem::remove_all(folder_, ignored);
  }
  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }
  const std::filesystem::path& path() const { return folder_; }

 private:
  Teuchos::RCP<const Communicator> communicator_;
  std::filesystem::path folder_;
};

}  // namespace kiln
