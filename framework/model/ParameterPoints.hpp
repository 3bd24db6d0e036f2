#pragma once

#include <string>
#include <vector>

#include "framework/model/Parameters.hpp"

namespace kiln {

/// Values of some of a model's live parameters at several points.
struct ParameterPoints {
  std::vector<std::string> names;           ///< as in Parameters::list()
  std::vector<std::vector<double>> values;  ///< in SI units: of each point, in the order of `names`

  /// The values that all of these parameters have now, as the only point.
  static ParameterPoints of(const Parameters& parameters);

  std::size_t count() const { return values.size(); }
  /// Points first … first + count − 1.
  ParameterPoints part(std::size_t first, std::size_t count) const;
  /// Gives live parameters their values at one of the points. Throws as Parameters::set.
  void set(std::size_t point, Parameters& parameters) const;
};

}  // namespace kiln
