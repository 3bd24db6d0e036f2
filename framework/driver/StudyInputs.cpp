#include "framework/driver/StudyInputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "framework/base/Hash.hpp"
#include "framework/driver/InputHashes.hpp"
#include "framework/driver/Run.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/files/DataFiles.hpp"
#include "framework/files/Folders.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"
#include "framework/input/Override.hpp"
#include "framework/report/Provenance.hpp"

namespace kiln {
namespace {

bool is_training(const StudyCase& item) { return item.command == "train"; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

void add_new(std::vector<Problem> found, std::vector<Problem>& problems) {
  for (Problem& problem : found) {
    const bool told = std::any_of(problems.begin(), problems.end(), [&](const Problem& other) {
      return other.path == problem.path && other.found == problem.found;
    });
    if (!told) problems.push_back(std::move(problem));
  }
}

}  // namespace

StudyInputs::StudyInputs(const Input& study, const std::vector<StudyCase>& cases,
                         const std::filesystem::path& working_folder, Teuchos::RCP<const Communicator> communicator)
    : study_(study),
      cases_(cases),
      working_folder_(working_folder),
      communicator_(std::move(communicator)),
      version_(provenance(*communicator_).at("kiln")) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    inputs_.emplace_back();
    try {
      inputs_[i] =
          Input::read(cases_[i].input, cases_[i].all_overrides(), run_specification(), *communicator_, promised(i));
    } catch (const InputError& error) {
      add_new(placed(error, cases_[i]), problems);
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::vector<std::string> StudyInputs::promised(std::size_t index) const {
  std::vector<std::string> files;
  for (auto needed = cases_[index].needs; needed; needed = cases_[*needed].needs) {
    for (const std::filesystem::path& file : results(*needed)) {
      files.push_back((working_folder_ / file).lexically_normal().string());
    }
  }
  return files;
}

std::vector<Problem> StudyInputs::placed(const InputError& error, const StudyCase& item) const {
  std::vector<Problem> problems = error.problems();
  const auto place = [&](const std::string& path) {
    return fmt::format("{}: {} (case '{}')", to_string(study_.location(path)), path, item.name);
  };
  for (Problem& problem : problems) {
    if (problem.path == item.input) problem.path = fmt::format("{}: {}", place(item.place + ".input"), item.input);
    for (const StudyCase::Override& override : item.overrides) {
      const std::string start = override_place(override.text);
      if (problem.path.compare(0, start.size(), start) != 0) continue;
      const std::string rest = problem.path.substr(start.size());
      // Another override's text may begin with this one's.
      if (!rest.empty() && rest.compare(0, 2, ": ") != 0) continue;
      problem.path = place(override.place) + rest;
      break;
    }
  }
  return problems;
}

void StudyInputs::build(const std::vector<std::size_t>& indices) const {
  std::vector<Problem> problems;
  std::set<std::string> built;
  for (const std::size_t i : indices) {
    const StudyCase& item = cases_[i];
    std::vector<std::string> overrides = item.all_overrides();
    const bool reduced = inputs_[i].list().sublist("method").get<std::string>("type") != "fom";
    overrides.emplace_back("method={type: fom}");
    // A reduced run may use a form of the Jacobian that the full order's would lack.
    if (reduced && !is_training(item)) overrides.emplace_back("time.newton.jacobian=finite difference");
    try {
      const Input full_order = Input::read(item.input, overrides, run_specification(), *communicator_, promised(i));
      Teuchos::ParameterList list = full_order.list();
      list.set("title", "");
      list.sublist("output").set("directory", item.command);
      if (!is_training(item)) list.remove("reduction", false);
      if (!built.insert(to_yaml(list)).second) continue;
      kiln::build(full_order, is_training(item), communicator_);
    } catch (const InputError& error) {
      add_new(placed(error, item), problems);
    } catch (const FileError& error) {
      add_new({{to_string(study_.location(item.place)), fmt::format("case '{}': {}", item.name, error.what()), {}, {}}},
              problems);
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::string StudyInputs::location_independent(std::size_t index) const {
  Teuchos::ParameterList list = inputs_[index].list();
  list.sublist("output").set("directory", "");
  const auto output = working_folder_ / study_.list().get<std::string>("output");
  return replaced(to_yaml(list), output.lexically_normal().string(), "{output}");
}

nlohmann::json StudyInputs::identity(std::size_t index, const std::string& needed_record) const {
  // Files of needed cases are known by those cases' records.
  const std::vector<std::string> made = promised(index);
  std::string data;
  if (communicator_->getRank() == 0) {
    for (const std::string& file : inputs_[index].data_files()) {
      if (std::find(made.begin(), made.end(), file) != made.end()) continue;
      // One that is gone since it was checked is told by the case itself.
      data += json_text(hash_of_data(file));
    }
  }
  return {{"kiln", version_},
          {"ranks", communicator_->getSize()},
          {"command", cases_[index].command},
          {"input", hash_of(location_independent(index))},
          {"data files", hash_of(broadcast(*communicator_, data))},
          {"needed case", needed_record}};
}

std::filesystem::path StudyInputs::report_folder(std::size_t index) const {
  Teuchos::ParameterList list = inputs_[index].list();
  // So that a case can be asked whose own input is wrong.
  list.sublist("output").set("directory", cases_[index].folder.string());
  if (is_training(cases_[index])) return training_folder(list);
  return list.isSublist("method") ? run_folder(list) : cases_[index].folder;
}

std::vector<std::filesystem::path> StudyInputs::results(std::size_t index) const {
  Teuchos::ParameterList list = inputs_[index].list();
  std::vector<std::filesystem::path> files = {report_folder(index) / "report.json"};
  list.sublist("output").set("directory", cases_[index].folder.string());
  if (is_training(cases_[index])) {
    files.push_back(reduction_file(list));
  } else if (list.sublist("output").isSublist("fields")) {
    files.push_back(report_folder(index) / "run.h5");
  }
  return files;
}

std::vector<std::string> StudyInputs::kind(std::size_t index) const {
  const Teuchos::ParameterList& list = inputs_[index].list();
  const char* const block = is_training(cases_[index]) ? "reduction" : "method";
  return {cases_[index].command, list.isSublist(block) ? list.sublist(block).get<std::string>("type") : ""};
}

}  // namespace kiln
