#include "framework/input/Input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>

#include "framework/input/Checker.hpp"
#include "framework/input/Include.hpp"
#include "framework/input/InputFiles.hpp"
#include "framework/input/Override.hpp"
#include "framework/plugin/Plugins.hpp"

namespace kiln {
namespace {

struct Parsed {
  YamlNode root;
  Mistakes mistakes;
};

struct Checked {
  Teuchos::ParameterList list;
  std::map<std::string, Location> locations;
  std::vector<std::string> data_files;
};

Parsed parse(const std::string& file, const std::vector<std::string>& overrides, InputFiles& files) {
  Parsed parsed;
  // A tree with holes would be blamed for what is missing in it.
  if (!read_with_includes(file, files, parsed.root, parsed.mistakes)) throw parsed.mistakes.error();
  for (const std::string& text : overrides) apply_override(text, parsed.root, parsed.mistakes);
  return parsed;
}

Checked check(const std::string& file, Parsed& parsed, const Specification& specification, InputFiles& files) {
  Checked checked;
  Checker checker(files, parsed.mistakes, std::filesystem::path(file).parent_path().string());
  checker.check(parsed.root, specification, checked.list);
  if (parsed.mistakes.count() != 0) throw parsed.mistakes.error();
  checked.locations = checker.locations();
  checked.data_files = files.data_files();
  return checked;
}

/// Does `work` on rank 0, and then on the other ranks with what the file system told rank 0. It is a pure function of
/// what the files answer, so every rank comes to the same end. Collective.
template <class Work>
auto on_every_rank(const Communicator& communicator, std::optional<InputFiles>& files, Work&& work) {
  if (communicator.getRank() != 0) {
    files = InputFiles::receive(communicator);
    return work(*files);
  }
  std::optional<decltype(work(*files))> result;
  std::exception_ptr failure;
  try {
    result = work(*files);
  } catch (...) {
    // The other ranks wait for the files whatever happened here.
    failure = std::current_exception();
  }
  files->send(communicator);
  if (failure) std::rethrow_exception(failure);
  return std::move(*result);
}

bool has_key(const Specification& specification, const std::string& key) {
  return std::any_of(specification.entries().begin(), specification.entries().end(),
                     [&](const auto& entry) { return entry->key == key; });
}

/// Loads what the key `plugins` names and puts the absolute paths in its place. What is no list of names is left to the
/// checker. Collective.
std::vector<std::string> load_plugins(const std::string& file, YamlNode& root, const Communicator& communicator) {
  YamlNode* const named = root.find("plugins");
  std::vector<std::string> paths;
  if (named == nullptr) return paths;
  for (YamlNode& item : named->items) {
    if (item.kind != YamlNode::Kind::scalar || item.text.empty()) continue;
    // An override stands in no file.
    const std::filesystem::path beside = item.location.line == 0 ? file : item.location.file;
    const std::string place = fmt::format("{}: plugins.{}", to_string(item.location), &item - named->items.data());
    item.text = plugins::load(item.text, beside.parent_path(), place, communicator);
    paths.push_back(item.text);
  }
  return paths;
}

}  // namespace

Input Input::read(const std::string& file, const std::vector<std::string>& overrides,
                  const Specification& specification, const Communicator& communicator,
                  const std::vector<std::string>& promised) {
  std::optional<InputFiles> files;
  if (communicator.getRank() == 0) {
    files.emplace();
    for (const std::string& path : promised) files->promise(path);
  }
  Parsed parsed = on_every_rank(communicator, files, [&](InputFiles& known) { return parse(file, overrides, known); });
  std::vector<std::string> libraries;
  if (has_key(specification, "plugins")) libraries = load_plugins(file, parsed.root, communicator);
  Checked checked =
      on_every_rank(communicator, files, [&](InputFiles& known) { return check(file, parsed, specification, known); });
  Input input;
  input.file_ = file;
  input.list_ = checked.list;
  input.list_.setName("");
  input.locations_ = std::move(checked.locations);
  input.text_files_ = files->text_files();
  input.data_files_ = std::move(checked.data_files);
  input.data_files_.insert(input.data_files_.end(), libraries.begin(), libraries.end());
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
