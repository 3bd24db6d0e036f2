#include "rom/files/ReductionIdentity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "framework/base/Error.hpp"
#include "framework/base/Hash.hpp"
#include "framework/files/DataFiles.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/Together.hpp"
#include "framework/input/Input.hpp"
#include "rom/files/YamlDifference.hpp"

namespace kiln::reduction_identity {
namespace {

constexpr std::size_t entries_named = 3;

std::string given(const std::string& value) { return value.empty() ? "none" : fmt::format("'{}'", value); }

/// "model.kernel.type: the reduction has 'cubic spline', this input 'wendland c2'; …"
std::string named(const std::vector<YamlDifference>& entries) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < std::min(entries.size(), entries_named); ++k) {
    lines.push_back(fmt::format("{}: the reduction has {}, this input {}", entries[k].path, given(entries[k].first),
                                given(entries[k].second)));
  }
  if (entries.size() > entries_named) lines.push_back(fmt::format("and {} more", entries.size() - entries_named));
  return fmt::format("{}", fmt::join(lines, "; "));
}

/// Of a text of the file and one of this input.
std::vector<YamlDifference> differences_to(const hdf5::Group& group, const std::string& attribute,
                                           const std::string& here, const std::string& prefix,
                                           const std::vector<std::string>& except) {
  try {
    return differences(group.text(attribute), here, prefix, except);
  } catch (const InputError& error) {
    throw FileError(group.file(), attribute, error.problems().front().found, "a checked block as YAML");
  }
}

/// What the file calls itself; empty: nothing, or something else than a text.
std::string format_of(const hdf5::Group& root) {
  try {
    return root.text("format");
  } catch (const FileError&) {
    return {};
  }
}

constexpr const char* data_group = "data_files";

/// The hash of a data file, read by rank 0 alone. Collective.
std::string data_hash(const std::string& file, const Communicator& communicator) {
  return broadcast(communicator, communicator.getRank() == 0 ? json_text(hash_of_data(file)) : std::string());
}

/// The scheme's block without its name, so that texts compare.
std::string scheme_text(const Teuchos::ParameterList& time) { return to_yaml(time.sublist("scheme")); }

}  // namespace

std::map<std::string, std::string> data_hashes(const Teuchos::ParameterList& model, const Communicator& communicator) {
  std::map<std::string, std::string> hashes;
  for (const DataFile& named : data_files(model)) hashes[named.path] = data_hash(named.file, communicator);
  return hashes;
}

void write(hdf5::Group& root, const Teuchos::ParameterList& input, const Parameters& parameters,
           const std::map<std::string, std::string>& data_hashes) {
  root.attribute("format", format);
  root.attribute("format_version", version);
  const Teuchos::ParameterList& model = input.sublist("model");
  const std::string text = to_yaml(model);
  root.attribute("model_type", model.get<std::string>("type"));
  root.attribute("model_input", text);
  root.attribute("model_hash", hash_of(text));
  hdf5::Group data = root.create_group(data_group);
  for (const auto& [path, hash] : data_hashes) data.attribute(path, hash);
  hdf5::Group live = root.create_group("parameters");
  for (const Parameter& parameter : parameters.list()) live.attribute(parameter.name, *parameter.value);
  const Teuchos::ParameterList& time = input.sublist("time");
  hdf5::Group steps = root.create_group("time");
  steps.attribute("step", time.get<double>("step"));
  steps.attribute("scheme", scheme_text(time));
}

void require_format(const hdf5::Group& root) {
  if (format_of(root) != format) {
    throw FileError(root.file(), "", "is an HDF5 file, but not a reduction", "a file written by `kiln train`");
  }
  const long long found = root.integer("format_version");
  if (found != version) {
    throw FileError(root.file(), "format_version", fmt::format("is {}", found),
                    fmt::format("{}: train again with this version of Kiln", version));
  }
}

void require_model(const hdf5::Group& root, const Teuchos::ParameterList& model) {
  const std::string trained = root.text("model_input");
  if (hash_of(trained) != root.text("model_hash")) {
    throw FileError(root.file(), "model_input", "does not match its hash: the file was changed after training");
  }
  std::vector<std::string> except;
  for (const std::string& name : root.group("parameters").attribute_names()) except.push_back("model." + name);
  const hdf5::Group data = root.group(data_group);
  std::vector<std::string> changed;
  const std::map<std::string, std::string> hashes = data_hashes(model, root.communicator());
  for (const DataFile& named : data_files(model)) {
    if (!data.has_attribute(named.path)) continue;
    except.push_back(named.path);
    if (data.text(named.path) != hashes.at(named.path)) {
      changed.push_back(fmt::format("{}: {}", named.path, named.file));
    }
  }
  const std::vector<YamlDifference> entries = differences_to(root, "model_input", to_yaml(model), "model", except);
  if (entries.empty() && changed.empty()) return;
  if (entries.empty()) {
    throw FileError(root.file(), "", fmt::format("was learnt from another file than {}", fmt::join(changed, " and ")),
                    "the data it was trained with; or train again");
  }
  throw FileError(root.file(), "", "belongs to another model: " + named(entries),
                  "the model it was trained for; or train again");
}

void require_time(const hdf5::Group& root, const Teuchos::ParameterList& time) {
  const hdf5::Group trained = root.group("time");
  std::vector<YamlDifference> entries;
  const double step = time.get<double>("step");
  if (trained.real("step") != step) {
    entries.push_back({"time.step", fmt::format("{} s", trained.real("step")), fmt::format("{} s", step)});
  }
  for (YamlDifference& entry : differences_to(trained, "scheme", scheme_text(time), "time.scheme", {})) {
    entries.push_back(std::move(entry));
  }
  if (entries.empty()) return;
  throw FileError(root.file(), "", "was trained with another time stepping: " + named(entries),
                  "the step and scheme it was trained with; or train again");
}

}  // namespace kiln::reduction_identity
