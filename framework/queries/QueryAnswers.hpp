#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/Model.hpp"
#include "framework/queries/PointBlock.hpp"

namespace kiln {

/// The answers to all points of a run, of which a rank holds those of its own, which follow each other.
struct QueryAnswers {
  ParameterPoints points;          ///< all
  std::vector<std::string> units;  ///< of their parameters
  std::vector<std::string> probes;
  std::vector<Field> fields;
  std::vector<long long> steps;  ///< that are recorded
  std::vector<double> times;     ///< likewise, in s
  std::size_t first = 0;         ///< of this rank's points
  std::vector<PointOutcome> outcomes;
  /// Of this rank's points: point by recorded step by probe by component; NaN after a point's divergence.
  std::vector<double> histories;

  /// Values of one point at one recorded step: probes × components.
  std::size_t width() const { return probes.size() * fields.size(); }
  double* row(std::size_t own_point, std::size_t recorded) {
    return histories.data() + (own_point * steps.size() + recorded) * width();
  }
  const double* row(std::size_t own_point, std::size_t recorded) const {
    return histories.data() + (own_point * steps.size() + recorded) * width();
  }
};

/// Writes queries.h5, which holds everything, and queries.csv, a row a point: its parameters, of each probe the highest
/// value, when, and the last one; steps, residuals, iterations, and whether it diverged. The same bytes for any number
/// of ranks. Collective.
void write_answers(const QueryAnswers& answers, const std::filesystem::path& folder,
                   const std::map<std::string, std::string>& provenance,
                   const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
