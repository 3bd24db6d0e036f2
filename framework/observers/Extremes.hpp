#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

#include "framework/observers/Observer.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Highest and lowest value of each component over all particles the method can tell, with place and time.
class Extremes : public Observer {
 public:
  Extremes(const Teuchos::ParameterList& list, const Context& context);
  static Specification specification();

  void observe(const Moment& moment) override;
  /// Section `observers`, key `extremes`: for each component `largest`, `smallest` and where they stood.
  void finish(RunReport& report) override;

 private:
  struct Extreme {
    double value;
    double time = 0.0;  ///< s
    GlobalIndex particle = -1;
  };
  Method& method_;
  Teuchos::RCP<const Communicator> communicator_;
  int every_;
  VectorView state_;
  std::vector<Extreme> largest_, smallest_;  ///< of this rank, one a component
};

}  // namespace kiln
