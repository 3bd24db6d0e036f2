#include "framework/input/InputFiles.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "framework/base/Collectives.hpp"
#include "framework/base/Hash.hpp"

namespace kiln {
namespace {

std::string why_unreadable(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return "there is no such file";
  if (status.type() == std::filesystem::file_type::directory) return "this is a folder";
  // Opening a pipe would wait for its other end.
  if (status.type() == std::filesystem::file_type::fifo) return "this is a pipe";
  if (status.type() == std::filesystem::file_type::socket) return "this is a socket";
  errno = 0;
  if (!std::ifstream(path)) return fmt::format("the file cannot be opened: {}", std::strerror(errno));
  return {};
}

/// Of a data file, which is read to its end by whoever wants it.
std::string why_no_data(const std::string& path) {
  std::error_code error;
  if (std::filesystem::status(path, error).type() == std::filesystem::file_type::character) return "this is a device";
  return why_unreadable(path);
}

InputFiles::Contents contents(const std::string& path) {
  std::string trouble = why_unreadable(path);
  if (!trouble.empty()) return {{}, std::move(trouble)};
  std::ifstream stream(path, std::ios::binary);
  std::string text;
  std::array<char, 65536> part{};
  // A device has no length to ask for beforehand.
  while (stream && text.size() <= InputFiles::longest) {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) return {{}, "the file cannot be read to its end"};
  if (text.size() > InputFiles::longest)
    return {{}, fmt::format("the file is longer than {} MiB", InputFiles::longest >> 20)};
  return {std::move(text), {}};
}

[[noreturn]] void throw_not_received(const std::string& path) {
  throw std::runtime_error(fmt::format("{}: rank 0 stopped before it read this file", path));
}

}  // namespace

InputFiles::InputFiles() : working_folder_(std::filesystem::current_path().string()) {}

InputFiles::InputFiles(const std::string& message) : received_(true) {
  // CBOR, since a file may hold any bytes.
  const nlohmann::json answers = nlohmann::json::from_cbor(message);
  working_folder_ = answers.at("working folder");
  for (const auto& [path, answer] : answers.at("contents").items()) {
    contents_[path] = {answer.at(0), answer.at(1)};
  }
  troubles_ = answers.at("troubles").get<std::map<std::string, std::string>>();
}

void InputFiles::send(const Teuchos::Comm<int>& communicator) const {
  nlohmann::json answers = {
      {"working folder", working_folder_}, {"contents", nlohmann::json::object()}, {"troubles", troubles_}};
  for (const auto& [path, file] : contents_) answers["contents"][path] = {file.text, file.trouble};
  std::string message;
  nlohmann::json::to_cbor(answers, message);
  broadcast(communicator, 0, message);
}

InputFiles InputFiles::receive(const Teuchos::Comm<int>& communicator) {
  std::string message;
  broadcast(communicator, 0, message);
  return InputFiles(message);
}

std::string InputFiles::absolute(const std::filesystem::path& path) const {
  return (std::filesystem::path(working_folder_) / path).lexically_normal().string();
}

const InputFiles::Contents& InputFiles::read(const std::string& path) {
  const auto known = contents_.find(path);
  if (known != contents_.end()) return known->second;
  if (received_) throw_not_received(path);
  return contents_[path] = contents(path);
}

std::vector<std::pair<std::string, std::string>> InputFiles::text_files() const {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [path, contents] : contents_) files.emplace_back(path, hash_of(contents.text));
  return files;
}

std::vector<std::string> InputFiles::data_files() const {
  std::vector<std::string> paths;
  for (const auto& [path, trouble] : troubles_) paths.push_back(path);
  return paths;
}

const std::string& InputFiles::trouble(const std::string& path) {
  const auto known = troubles_.find(path);
  if (known != troubles_.end()) return known->second;
  if (received_) throw_not_received(path);
  return troubles_[path] = why_no_data(path);
}

}  // namespace kiln
