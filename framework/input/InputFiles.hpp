#pragma once

#include <Teuchos_Comm.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kiln {

/// What the input layer asks of the file system. Rank 0 asks it and keeps the answers; the other ranks receive these,
/// so that all ranks see one and the same file system and throw the same error.
class InputFiles {
 public:
  struct Contents {
    std::string text;
    std::string trouble;  ///< why the file cannot be read, e.g. "there is no such file"; empty: it was
  };
  /// Files longer than this are taken for data given by mistake.
  static constexpr std::size_t longest = std::size_t{16} << 20;

  InputFiles();
  /// Collective: rank 0 of the communicator calls send, all others receive.
  void send(const Teuchos::Comm<int>& communicator) const;
  static InputFiles receive(const Teuchos::Comm<int>& communicator);

  /// The path made absolute against the folder Kiln was started in, "." and ".." removed.
  std::string absolute(const std::filesystem::path& path) const;
  /// `path` is absolute.
  const Contents& read(const std::string& path);
  /// A file that is not there yet but will be when it is wanted. `path` is absolute. Rank 0 alone.
  void promise(const std::string& path) { troubles_[path].clear(); }
  /// All files that were read, absolute, each with the XXH3 hash (128 bits) of its text.
  std::vector<std::pair<std::string, std::string>> text_files() const;
  /// All files that were asked for by trouble(), absolute.
  std::vector<std::string> data_files() const;
  /// Why a data file cannot be opened; empty: it can. Devices and pipes have no end one could count on, or no
  /// beginning. `path` is absolute.
  const std::string& trouble(const std::string& path);

 private:
  explicit InputFiles(const std::string& message);
  bool received_ = false;
  std::string working_folder_;
  std::map<std::string, Contents> contents_;
  std::map<std::string, std::string> troubles_;
};

}  // namespace kiln
