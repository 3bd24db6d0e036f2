#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

enum class CaseStatus { to_do, running, complete, failed, skipped };

/// "to do", "running", "complete", "failed", "skipped".
const char* to_string(CaseStatus status);

/// What a study leaves in a case's folder, as case.json: whether its results are there, and what of. It says `running`
/// from the start of the case, and `complete` only once everything else is written.
struct CaseRecord {
  CaseStatus status = CaseStatus::to_do;
  /// What the results depend on, flat: the case is complete for as long as all of it stays the same.
  nlohmann::json identity = nlohmann::json::object();
  double seconds = 0.0;    ///< wall time; of the last part for a continued case
  std::string message;     ///< why it failed
  bool continued = false;  ///< from the checkpoint of an interrupted start

  /// Of the record's bytes: tells this completion of the case from any other. Empty for a record not read from a file.
  std::string hash;
};

/// Nothing if there is no record, or none that this Kiln can read. Collective.
std::optional<CaseRecord> read_case_record(const std::filesystem::path& folder, const Communicator& communicator);

/// Makes the folder if it is missing and writes the record in one stroke; takes its hash. Throws FileError. Collective.
void write_case_record(const std::filesystem::path& folder, const std::string& name, CaseRecord& record,
                       const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
