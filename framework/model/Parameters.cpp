#include "framework/model/Parameters.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "framework/base/Error.hpp"
#include "framework/base/Nearest.hpp"

namespace kiln {

std::string Parameter::trouble(double proposed) const {
  if (!std::isfinite(proposed)) return "not finite";
  if (allowed == Allowed::not_negative && proposed < 0.0) return "below 0";
  if (allowed == Allowed::positive && proposed <= 0.0) return "not above 0";
  return {};
}

const char* Parameter::range() const {
  if (allowed == Allowed::any) return "";
  return allowed == Allowed::positive ? " above 0" : " at least 0";
}

void Parameters::add(std::string name, std::string unit, double* value, Allowed allowed) {
  for (const Parameter& known : parameters_) {
    if (known.name == name) throw std::logic_error(fmt::format("model parameter '{}' is listed twice", name));
  }
  parameters_.push_back({std::move(name), std::move(unit), value, allowed});
}

void Parameters::add(std::string_view prefix, const Parameters& component) {
  for (const Parameter& parameter : component.parameters_) {
    add(fmt::format("{}.{}", prefix, parameter.name), parameter.unit, parameter.value, parameter.allowed);
    parameters_.back().mirrors = parameter.mirrors;
  }
}

void Parameters::mirror(const Parameters& other) {
  if (other.parameters_.size() != parameters_.size()) {
    throw std::logic_error(
        fmt::format("a model of {} parameters cannot mirror one of {}", other.parameters_.size(), parameters_.size()));
  }
  for (Parameter& parameter : parameters_) {
    const Parameter& twin = other.find(parameter.name);
    parameter.mirrors.push_back(twin.value);
    parameter.mirrors.insert(parameter.mirrors.end(), twin.mirrors.begin(), twin.mirrors.end());
  }
}

const Parameter& Parameters::find(std::string_view name) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.name == name) return parameter;
  }
  std::vector<std::string> known;
  for (const Parameter& parameter : parameters_) known.push_back(parameter.name);
  throw InputError(
      "", fmt::format("the model has no parameter '{}'", name),
      known.empty() ? "no parameter at all: the model lists none" : fmt::format("one of: {}", fmt::join(known, ", ")),
      nearest(std::string(name), known));
}

double Parameters::get(std::string_view name) const { return *find(name).value; }

void Parameters::set(std::string_view name, double value) {
  const Parameter& parameter = find(name);
  if (!parameter.trouble(value).empty()) {
    throw InputError("", fmt::format("parameter '{}' is set to {}", name, value),
                     fmt::format("a finite number in {}{}", parameter.unit, parameter.range()));
  }
  *parameter.value = value;
  for (double* mirror : parameter.mirrors) *mirror = value;
}

}  // namespace kiln
