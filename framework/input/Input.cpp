#include "framework/input/Input.hpp"

#include <exception>
#include <filesystem>
#include <optional>

#include "framework/input/Checker.hpp"
#include "framework/input/Include.hpp"
#include "framework/input/InputFiles.hpp"
#include "framework/input/Override.hpp"

namespace kiln {
namespace {

struct Checked {
  Teuchos::ParameterList list;
  std::map<std::string, Location> locations;
  std::vector<std::string> data_files;
};

/// A pure function of what `files` answers, so that every rank comes to the same end.
Checked check(const std::string& file, const std::vector<std::string>& overrides, const Specification& specification,
              InputFiles& files) {
  Mistakes mistakes;
  YamlNode root;
  // A tree with holes would be blamed for what is missing in it.
  if (!read_with_includes(file, files, root, mistakes)) throw mistakes.error();
  for (const std::string& text : overrides) apply_override(text, root, mistakes);
  Checked checked;
  Checker checker(files, mistakes, std::filesystem::path(file).parent_path().string());
  checker.check(root, specification, checked.list);
  if (mistakes.count() != 0) throw mistakes.error();
  checked.locations = checker.locations();
  checked.data_files = files.data_files();
  return checked;
}

}  // namespace

Input Input::read(const std::string& file, const std::vector<std::string>& overrides,
                  const Specification& specification, const Communicator& communicator,
                  const std::vector<std::string>& promised) {
  std::optional<Checked> checked;
  if (communicator.getRank() == 0) {
    InputFiles files;
    for (const std::string& path : promised) files.promise(path);
    std::exception_ptr failure;
    try {
      checked = check(file, overrides, specification, files);
    } catch (...) {
      // The other ranks wait for the files whatever happened here.
      failure = std::current_exception();
    }
    files.send(communicator);
    if (failure) std::rethrow_exception(failure);
  } else {
    InputFiles files = InputFiles::receive(communicator);
    checked = check(file, overrides, specification, files);
  }
  Input input;
  input.file_ = file;
  input.list_ = std::move(checked->list);
  input.list_.setName("");
  input.locations_ = std::move(checked->locations);
  input.data_files_ = std::move(checked->data_files);
  return input;
}

Location Input::location(const std::string& path) const {
  std::string place = path;
  for (;;) {
    const auto known = locations_.find(place);
    if (known != locations_.end()) return known->second;
    if (place.empty()) return {file_, 1, 1};
    const std::size_t dot = place.rfind('.');
    place = dot == std::string::npos ? "" : place.substr(0, dot);
  }
}

InputError Input::located(const InputError& error) const {
  Mistakes mistakes;
  mistakes.begin_file(file_);
  for (const Problem& problem : error.problems()) mistakes.add(location(problem.path), problem);
  return mistakes.error();
}

std::string Input::merged() const { return to_yaml(list_); }

}  // namespace kiln
