#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/registry/Specification.hpp"

namespace kiln {

/// The blocks `reduction.basis` and `reduction.residual_basis`: how a POD is computed and where it is cut off.
struct PodSettings {
  enum class Algorithm {
    gram,       ///< eigenvectors of SᵀS
    tsqr,       ///< QR of S spread over the ranks, then the SVD of R
    randomised  ///< SVD of S projected on the range of S (SᵀS)² Ω, Ω random: for few vectors of many snapshots
  };
  enum class EnergyOf { squared_singular_values, singular_values };

  std::string path = "basis";  ///< of the block in the input, for messages
  Algorithm algorithm = Algorithm::gram;
  EnergyOf energy_of = EnergyOf::squared_singular_values;
  std::optional<int> rank;
  bool rank_is_cap = false;      ///< fewer vectors will do where the snapshots hold no more
  std::optional<double> energy;  ///< fraction in (0, 1]
  int at_least = 0;              ///< vectors where the energy alone asks for fewer and the snapshots hold more

  PodSettings() = default;
  explicit PodSettings(const Teuchos::ParameterList& list);
  static Specification specification();

  /// Of m snapshots, singular values at or below this fraction of the largest are round-off of the algorithm: √(m ε)
  /// for gram, whose eigenvalues σ² carry errors of m ε σ_1², and 10 m ε for tsqr; m at least 10.
  double resolution(std::size_t snapshots) const;
};

/// Where a POD is cut off.
struct Truncation {
  int rank = 0;         ///< columns kept
  int independent = 0;  ///< singular values above PodSettings::resolution()
  double energy =
      0.0;  ///< fraction kept, of the independent ones' Σσ² or Σσ; randomised: of the Σσ² of all that are held
};

/// Smallest rank that keeps the energy asked for (at least `at_least`), or the rank asked for. `singular_values`, of so
/// many snapshots, descend. Throws InputError if nothing is independent (all snapshots zero) or a rank above
/// `independent` is asked for. `held`: of how many columns the singular values are, where a hold has made them fewer.
Truncation truncate(const std::vector<double>& singular_values, std::size_t snapshots, const PodSettings& settings,
                    std::optional<std::size_t> held = std::nullopt);

}  // namespace kiln
