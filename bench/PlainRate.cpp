#include "bench/PlainRate.hpp"

namespace kiln::bench {

PlainRate::PlainRate(const HeatModel& model)
    : table_(model.material()),
      offsets_(model.domain().pairs.offsets.data(),
               model.domain().pairs.offsets.data() + model.domain().pairs.offsets.extent(0)),
      columns_(model.domain().pairs.neighbours.data(),
               model.domain().pairs.neighbours.data() + model.domain().pairs.neighbours.extent(0)),
      weights_(model.domain().weights.data(), model.domain().weights.data() + model.domain().weights.extent(0)),
      masses_(model.domain().masses.data(), model.domain().masses.data() + model.domain().masses.extent(0)),
      conductivity_(masses_.size()),
      volume_(masses_.size()),
      specific_heat_(masses_.size()),
      rate_(offsets_.size() - 1) {}

void PlainRate::evaluate(const VectorView& u) {
  for (std::size_t j = 0; j < masses_.size(); ++j) {
    const MaterialPoint<double> point = table_.at(u(j));
    conductivity_[j] = point.conductivity;
    volume_[j] = masses_[j] / point.density;
    specific_heat_[j] = point.specific_heat;
  }
  for (std::size_t i = 0; i < rate_.size(); ++i) {
    const double u_i = u(i);
    const double k_i = conductivity_[i];
    double sum = 0.0;
    for (std::size_t pair = offsets_[i]; pair < offsets_[i + 1]; ++pair) {
      const int j = columns_[pair];
      sum += volume_[j] * 4.0 * k_i * conductivity_[j] / (k_i + conductivity_[j]) * (u_i - u(j)) * weights_[pair];
    }
    rate_[i] = sum * volume_[i] / (masses_[i] * specific_heat_[i]);
  }
}

}  // namespace kiln::bench
