#include "framework/driver/StudyCases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"
#include "framework/registry/EntryText.hpp"

namespace kiln {
namespace {

/// Turns the blocks of `cases:` into cases one after the other and collects what is wrong with them.
class Expansion {
 public:
  Expansion(const Input& study, const std::filesystem::path& working_folder)
      : study_folder_(std::filesystem::path(study.file()).parent_path()),
        output_(study.list().get<std::string>("output")),
        absolute_output_((working_folder / output_).lexically_normal()) {}

  void expand(const Teuchos::ParameterList& block, const std::string& place) {
    std::vector<std::pair<std::string, std::vector<std::string>>> names;
    if (block.isSublist("for")) {
      const Teuchos::ParameterList& list = block.sublist("for");
      for (auto entry = list.begin(); entry != list.end(); ++entry) {
        names.emplace_back(list.name(entry), texts_in(list, list.name(entry)));
      }
    }
    for (PlaceholderValues& values : combinations(names)) add(block, place, std::move(values));
  }

  std::vector<StudyCase> cases;
  std::vector<Problem> problems;

 private:
  void refuse(Problem problem) {
    const bool told = std::any_of(problems.begin(), problems.end(), [&](const Problem& other) {
      return other.path == problem.path && other.found == problem.found;
    });
    if (!told) problems.push_back(std::move(problem));
  }

  std::string fill(const std::string& text, const PlaceholderValues& values, const std::string& place) {
    try {
      return fill_placeholders(text, values);
    } catch (const InputError& error) {
      Problem problem = error.problems().front();
      problem.path = place;
      refuse(std::move(problem));
      return {};
    }
  }

  void add(const Teuchos::ParameterList& block, const std::string& place, PlaceholderValues values) {
    StudyCase item;
    item.place = place;
    item.command = block.get<std::string>("command");
    const std::size_t before = problems.size();
    item.name = fill(block.get<std::string>("name"), values, place + ".name");
    if (problems.size() == before) check_name(item.name, place + ".name");
    item.folder = output_ / item.name;
    item.values = values;
    if (block.isParameter("needs")) {
      item.needs = find(fill(block.get<std::string>("needs"), values, place + ".needs"), place + ".needs");
      const std::string needed = item.needs ? cases[*item.needs].name : std::string();
      values.emplace_back("needs", (absolute_output_ / needed).string());
    }
    item.input = (study_folder_ / fill(block.get<std::string>("input"), values, place + ".input")).string();
    if (block.isSublist("set")) add_overrides(block.sublist("set"), place + ".set", values, item);
    indices_.emplace(item.name, cases.size());
    cases.push_back(std::move(item));
  }

  void add_overrides(const Teuchos::ParameterList& set, const std::string& place, const PlaceholderValues& values,
                     StudyCase& item) {
    for (auto entry = set.begin(); entry != set.end(); ++entry) {
      const std::string entry_place = place + "." + set.name(entry);
      const std::string path = fill(set.name(entry), values, entry_place);
      if (path == "output" || path == "output.directory") {
        refuse({entry_place, "the study sets the case's folder itself", "the case's `name`", {}});
      }
      std::string text;
      if (set.isType<Teuchos::Array<std::string>>(set.name(entry))) {
        std::vector<std::string> items;
        for (const std::string& one : texts_in(set, set.name(entry))) {
          items.push_back(yaml_text(fill(one, values, entry_place)));
        }
        text = fmt::format("[{}]", fmt::join(items, ", "));
      } else {
        text = fill(set.get<std::string>(set.name(entry)), values, entry_place);
      }
      item.overrides.push_back({path + "=" + text, entry_place});
    }
  }

  void check_name(const std::string& name, const std::string& place) {
    const std::filesystem::path path(name);
    const bool leaves = path.is_absolute() || path.lexically_normal().string() != name || *path.begin() == "..";
    if (leaves || !path.has_filename() || path == ".") {
      refuse(
          {place, fmt::format("{} is no folder below `output`", in_quotes(name)), "a name such as part/gnat-1e-3", {}});
    }
    if (const auto known = indices_.find(name); known != indices_.end()) {
      refuse({place, fmt::format("another case is named {}", in_quotes(name)), "a name of its own for each case", {}});
    }
  }

  std::optional<std::size_t> find(const std::string& name, const std::string& place) {
    if (name.empty()) return std::nullopt;
    if (const auto known = indices_.find(name); known != indices_.end()) return known->second;
    std::vector<std::string> names;
    for (const StudyCase& item : cases) names.push_back(item.name);
    refuse({place, fmt::format("no case before this one is named {}", in_quotes(name)),
            "the name of a case further up in the file", nearest(name, names)});
    return std::nullopt;
  }

  std::filesystem::path study_folder_, output_, absolute_output_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

std::vector<std::string> StudyCase::all_overrides() const {
  std::vector<std::string> texts;
  for (const Override& override : overrides) texts.push_back(override.text);
  texts.push_back("output.directory=" + yaml_text(folder.string()));
  return texts;
}

std::vector<StudyCase> expand_study(const Input& study, const std::filesystem::path& working_folder) {
  Expansion expansion(study, working_folder);
  const Teuchos::ParameterList& blocks = study.list().sublist("cases");
  for (auto block = blocks.begin(); block != blocks.end(); ++block) {
    expansion.expand(blocks.sublist(blocks.name(block)), "cases." + blocks.name(block));
  }
  if (!expansion.problems.empty()) throw study.located(InputError(expansion.problems));
  return std::move(expansion.cases);
}

}  // namespace kiln
