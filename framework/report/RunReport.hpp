#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "framework/base/LinearAlgebra.hpp"

namespace kiln {

/// What a run says of itself at its end: facts gathered by the driver, the method and the observers, written as
/// report.json and printed as a table.
class RunReport {
 public:
  /// A named part of the report, created on first use.
  nlohmann::json& section(const std::string& name) { return facts_[name]; }
  const nlohmann::json& facts() const { return facts_; }

 private:
  nlohmann::json facts_ = nlohmann::json::object();
};

/// The facts in `folder`/report.json. Throws FileError for a file that is missing or no report. Collective.
nlohmann::json read_report(const std::filesystem::path& folder, const Communicator& communicator);

}  // namespace kiln
