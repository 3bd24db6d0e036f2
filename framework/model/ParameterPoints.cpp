#include "framework/model/ParameterPoints.hpp"

namespace kiln {

ParameterPoints ParameterPoints::of(const Parameters& parameters) {
  ParameterPoints result;
  result.values.emplace_back();
  for (const Parameter& parameter : parameters.list()) {
    result.names.push_back(parameter.name);
    result.values.front().push_back(*parameter.value);
  }
  return result;
}

ParameterPoints ParameterPoints::part(std::size_t first, std::size_t count) const {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return {names, {begin, begin + static_cast<std::ptrdiff_t>(count)}};
}

void ParameterPoints::set(std::size_t point, Parameters& parameters) const {
  for (std::size_t k = 0; k < names.size(); ++k) parameters.set(names[k], values[point][k]);
}

}  // namespace kiln
