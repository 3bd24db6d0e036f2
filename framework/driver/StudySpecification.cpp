#include "framework/driver/StudySpecification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

void check_placeholders(const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
  if (!list.isSublist("for")) return;
  const Teuchos::ParameterList& names = list.sublist("for");
  for (auto entry = names.begin(); entry != names.end(); ++entry) {
    const std::string& name = names.name(entry);
    const std::vector<std::string>& taken = study_columns();
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      problems.push_back({"for." + name,
                          "this name has a meaning of its own",
                          fmt::format("another name than: {}", fmt::join(taken, ", ")),
                          {}});
    }
    if (name.find_first_of("{}.") != std::string::npos) {
      problems.push_back({"for." + name, "a name with '{', '}' or '.'", "a name without them", {}});
    }
    if (names.isType<Teuchos::Array<std::string>>(name) && names.get<Teuchos::Array<std::string>>(name).empty()) {
      problems.push_back({"for." + name, "an empty list is given", "one value or more", {}});
    }
  }
}

Specification case_specification() {
  Specification s;
  s.text("name", "of the case and of its folder below `output`, e.g. part/gnat-{tolerance}; {…} as `for` says");
  s.dictionary("for", "placeholders and their values: a case for each combination, e.g. {tolerance: [1e-3, 1e-2]}")
      .optional();
  s.text("input", "input file of the case, relative to the study file");
  s.choice("command", "what to do with it", {"run", "train"}).defaults_to("run");
  s.dictionary("set", "entries of the input to change, as --set does, e.g. {method.type: gnat}").optional();
  s.text("needs", "name of an earlier case that must be complete; {needs} then stands for its folder").optional();
  s.check(check_placeholders);
  return s;
}

}  // namespace

const std::vector<std::string>& study_columns() {
  static const std::vector<std::string> columns = {"name",   "command", "status", "seconds",   "message",
                                                   "folder", "report",  "input",  "continued", "needs"};
  return columns;
}

Specification study_specification() {
  Specification s;
  s.text("title", "one line that names the study").defaults_to("");
  s.text("output", "folder of the study, relative to where kiln is started; a case writes into its subfolder `name`");
  s.sections("cases", "what to run, in this order", case_specification());
  return s;
}

}  // namespace kiln
