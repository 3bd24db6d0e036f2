#include "framework/driver/StudyStates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>

namespace kiln {
namespace {

/// "Kiln's version, the input": what differs between two identities.
std::string changes(const nlohmann::json& before, const nlohmann::json& now) {
  std::vector<std::string> names;
  for (const auto& [key, value] : now.items()) {
    if (!before.contains(key) || before.at(key) != value) names.push_back(key);
  }
  return fmt::format("changed: {}", fmt::join(names, ", "));
}

}  // namespace

bool exist(const std::vector<std::filesystem::path>& files, const Communicator& communicator) {
  std::error_code ignored;
  int all = std::all_of(files.begin(), files.end(),
                        [&](const std::filesystem::path& file) { return std::filesystem::exists(file, ignored); });
  Teuchos::broadcast(communicator, 0, Teuchos::outArg(all));
  return all != 0;
}

CaseState state_of(std::size_t index, const std::vector<StudyCase>& cases, const StudyInputs& inputs,
                   const std::vector<CaseState>& before, const Communicator& communicator) {
  const StudyCase& item = cases[index];
  CaseState state;
  state.record = read_case_record(item.folder, communicator);
  std::string needed_record;
  if (item.needs) {
    const CaseState& needed = before[*item.needs];
    if (needed.status != CaseStatus::complete) {
      state.why = fmt::format("needs {} ({})", cases[*item.needs].name, to_string(needed.status));
      return state;
    }
    needed_record = needed.record->hash;
  }
  state.identity = inputs.identity(index, needed_record);
  if (!state.record) return state;
  if (!state.same_as_recorded()) {
    state.why = changes(state.record->identity, state.identity);
    return state;
  }
  state.status = state.record->status;
  if (state.status == CaseStatus::complete && !exist(inputs.results(index), communicator)) {
    state.status = CaseStatus::to_do;
    state.why = "its results are gone";
  }
  return state;
}

nlohmann::json states_table(const std::vector<StudyCase>& cases, const StudyInputs& inputs,
                            const std::vector<CaseState>& states) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseState& state = states[i];
    const bool ran = state.status == CaseStatus::complete || state.status == CaseStatus::failed;
    nlohmann::json row = {{"name", cases[i].name},
                          {"command", cases[i].command},
                          {"status", to_string(state.status)},
                          {"seconds", nullptr},
                          {"continued", ran && state.record->continued},
                          {"message", ran ? state.record->message : state.why},
                          {"folder", cases[i].folder.string()},
                          {"report", (inputs.report_folder(i) / "report.json").string()},
                          {"input", cases[i].input},
                          {"needs", cases[i].needs ? cases[*cases[i].needs].name : ""}};
    if (ran) row["seconds"] = state.record->seconds;
    for (const auto& [name, value] : cases[i].values) row[name] = value;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace kiln
