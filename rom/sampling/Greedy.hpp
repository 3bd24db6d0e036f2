#pragma once

#include <string>

#include "rom/sampling/Sampling.hpp"

namespace kiln {

/// Greedy sampling of GNAT (Carlberg, Farhat, Cortial, Amsallem 2013, Algorithm 3): residual modes enter one turn after
/// another, and each turn adds the particles where the modes that enter are told worst by the earlier ones at the
/// particles chosen so far. Errors of a particle's components add up. Errors equal to 1e-6 count as ties, and the
/// lowest id wins, so that the round-off of a number of ranks changes nothing. A particle that all modes move as one
/// already chosen, such as its mirror image in a symmetric problem, tells nothing new and is left for the end.
class Greedy : public Sampling {
 public:
  static Specification specification();
  Greedy(const Teuchos::ParameterList& list, const NoContext&);

  void check(GlobalIndex particles, int components, int residual_modes) const override;
  std::vector<GlobalIndex> sample(const Map& rows, ConstMatrixView modes, int components) const override;

 private:
  std::vector<GlobalIndex> checked_seeds(GlobalIndex particles) const;
  int checked_samples(GlobalIndex particles, int modes, int components, int seeds) const;

  std::string path_;
  int samples_;  ///< 0: as many as the residual rank times samples_per_mode_
  double samples_per_mode_;
  std::vector<GlobalIndex> seeds_;
};

}  // namespace kiln
