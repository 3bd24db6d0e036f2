#include "framework/driver/StudyRecord.hpp"

#include <array>
#include <chrono>
#include <fstream>
#include <sstream>

#include "framework/base/Hash.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"

namespace kiln {
namespace {

constexpr int format = 1;
constexpr std::array statuses = {CaseStatus::to_do, CaseStatus::running, CaseStatus::complete, CaseStatus::failed,
                                 CaseStatus::skipped};

std::filesystem::path file_in(const std::filesystem::path& folder) { return folder / "case.json"; }

std::optional<CaseRecord> parse(const std::string& text) {
  try {
    const nlohmann::json facts = parse_json(text);
    if (facts.at("format") != format) return std::nullopt;
    CaseRecord record;
    for (const CaseStatus status : statuses) {
      if (facts.at("status") == to_string(status)) record.status = status;
    }
    record.identity = facts.at("identity");
    record.seconds = facts.at("seconds");
    record.message = facts.at("message");
    record.continued = facts.at("continued");
    record.hash = hash_of(text);
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

const char* to_string(CaseStatus status) {
  switch (status) {
    case CaseStatus::to_do:
      return "to do";
    case CaseStatus::running:
      return "running";
    case CaseStatus::complete:
      return "complete";
    case CaseStatus::failed:
      return "failed";
    case CaseStatus::skipped:
      return "skipped";
  }
  throw std::logic_error("a case without a status");
}

std::optional<CaseRecord> read_case_record(const std::filesystem::path& folder, const Communicator& communicator) {
  std::ostringstream text;
  if (communicator.getRank() == 0) text << std::ifstream(file_in(folder)).rdbuf();
  return parse(broadcast(communicator, text.str()));
}

void write_case_record(const std::filesystem::path& folder, const std::string& name, CaseRecord& record,
                       const Teuchos::RCP<const Communicator>& communicator) {
  on_root(*communicator, folder.string(), [&]() -> std::optional<Fault> {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return system_fault("made", error.value());
    return std::nullopt;
  });
  // The moment tells two completions of the same length apart.
  const auto moment = std::chrono::system_clock::now().time_since_epoch();
  const nlohmann::json facts = {{"format", format},
                                {"name", name},
                                {"status", to_string(record.status)},
                                {"identity", record.identity},
                                {"seconds", record.seconds},
                                {"message", record.message},
                                {"continued", record.continued},
                                {"written_unix_ns", std::chrono::nanoseconds(moment).count()}};
  const std::string text = broadcast(*communicator, json_text(facts, 2) + "\n");
  write_atomically(file_in(folder), text, communicator);
  record.hash = hash_of(text);
}

}  // namespace kiln
