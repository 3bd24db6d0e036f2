#include "framework/driver/InputHashes.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "framework/files/DataFiles.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

constexpr const char* kind = "kind";
constexpr const char* data = "data";

}  // namespace

nlohmann::json input_hashes(const Input& input, const Communicator& communicator) {
  std::string text;
  if (communicator.getRank() == 0) {
    nlohmann::json hashes = nlohmann::json::array();
    for (const auto& [file, hash] : input.text_files()) {
      hashes.push_back({{"file", file}, {kind, "text"}, {"xxh3", hash}});
    }
    for (const std::string& file : input.data_files()) {
      hashes.push_back({{"file", file}, {kind, data}});
      hashes.back().update(hash_of_data(file));
    }
    text = json_text(hashes);
  }
  return nlohmann::json::parse(broadcast(communicator, text));
}

std::string data_identity(const nlohmann::json& hashes) {
  std::string identity;
  for (const nlohmann::json& entry : hashes) {
    if (entry[kind] != data) continue;
    const std::string name = std::filesystem::path(entry["file"].get<std::string>()).filename().string();
    identity += fmt::format("  {}: {}\n", name, entry[entry.contains("seal") ? "seal" : "xxh3"].get<std::string>());
  }
  return identity;
}

}  // namespace kiln
