#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/files/CsvLog.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Writes the highest and the lowest value of each component over all particles the method can tell, and the particles
/// they stand at, into extremes.csv.
class Extremes : public Observer {
 public:
  static Specification specification();
  Extremes(const Teuchos::ParameterList& list, const Context& context);

  void begin() override;
  void observe(const Moment& moment) override;
  /// Section `observers`, key `extremes`: for each component `largest` and `smallest` of the whole run, earlier parts
  /// of a restarted one included, with time and particle.
  void finish(RunReport& report) override;

 private:
  std::vector<std::string> columns() const;
  /// Value and particle of the largest and the smallest of each component on this rank, in turn.
  std::vector<double> local_extremes(const Moment& moment);
  /// The global id, exact as a double, of the first particle on this rank with this value now; −1 without one.
  double particle_with(double value, std::size_t component) const;

  Context context_;
  int every_;
  std::vector<Field> fields_;
  VectorView state_;
  VectorView::HostMirror state_host_;
  std::unique_ptr<CsvLog> log_;  ///< null before begin()
};

}  // namespace kiln
