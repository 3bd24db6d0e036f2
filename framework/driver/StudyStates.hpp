#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/driver/StudyInputs.hpp"
#include "framework/driver/StudyRecord.hpp"

namespace kiln {

/// Where a case stands, from its record and what it depends on now.
struct CaseState {
  CaseStatus status = CaseStatus::to_do;
  std::string why;                   ///< of `to do` and `skipped`
  nlohmann::json identity;           ///< null while the needed case is not complete
  std::optional<CaseRecord> record;  ///< of this or an earlier identity

  bool same_as_recorded() const { return record && record->identity == identity; }
};

/// The state of one case, from those of the cases before it. `running` is said of an interrupted case. Collective.
CaseState state_of(std::size_t index, const std::vector<StudyCase>& cases, const StudyInputs& inputs,
                   const std::vector<CaseState>& before, const Communicator& communicator);

/// Whether all the files exist, as rank 0 sees it. Collective.
bool exist(const std::vector<std::filesystem::path>& files, const Communicator& communicator);

/// study.json: a list of flat objects, one a case, as pandas.read_json takes it.
nlohmann::json states_table(const std::vector<StudyCase>& cases, const StudyInputs& inputs,
                            const std::vector<CaseState>& states);

}  // namespace kiln
