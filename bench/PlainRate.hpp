#pragma once

#include <vector>

#include "physics/sph/HeatModel.hpp"

namespace kiln::bench {

/// Eq. 11 as a competent programmer writes it first: a compressed-row gather with stored weights, in double precision
/// with int columns, one loop over the neighbours of each particle. The measure of the kernels that a model uses.
class PlainRate {
 public:
  explicit PlainRate(const HeatModel& model);
  /// f of the rows from u of the sources, without a heat source. Keeps the result in rate().
  void evaluate(const VectorView& u);
  const std::vector<double>& rate() const { return rate_; }
  std::size_t pairs() const { return columns_.size(); }

 private:
  const MaterialTable& table_;
  std::vector<std::size_t> offsets_;
  std::vector<int> columns_;
  std::vector<double> weights_, masses_;
  std::vector<double> conductivity_, volume_, specific_heat_, rate_;
};

}  // namespace kiln::bench
