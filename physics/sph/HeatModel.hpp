#pragma once

#include <Teuchos_ParameterList.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "framework/model/LastParameters.hpp"
#include "framework/model/LastState.hpp"
#include "framework/model/Model.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "framework/model/SumsOverRun.hpp"
#include "framework/registry/Specification.hpp"
#include "physics/sph/HeatDomain.hpp"
#include "physics/sph/HeatSource.hpp"
#include "physics/sph/MaterialTable.hpp"
#include "physics/sph/PairLayout.hpp"

namespace kiln {

/// Heat conduction and deposition by smoothed particle hydrodynamics, the model of the NRL report (Eqs. 6–20):
///
///     f_i = 1/(ρ_i c_i) Σ_j m_j/ρ_j · 4 k_i k_j/(k_i + k_j) · (u_i − u_j) r_ij·∇W_ij/r_ij² + q_i A_i/(c_i m_i),
///
/// with ρ, c, k of the temperature from a table, masses fixed by ρ at the initial temperature, and the gradient of W
/// taken at particle i. Pair terms are antisymmetric: Σ m_i c_i f_i = Σ q_i A_i to round-off.
///
/// Evaluations write to work arrays the model keeps: one evaluation at a time.
class HeatModel final : public Model, public PairwiseModel, public SumsOverRun {
 public:
  static Specification specification();
  HeatModel(const Teuchos::ParameterList& list, const Context& context);
  /// From a group written by save_sample. `list` is the model's own checked block; particles, kernel and material are
  /// not read again.
  HeatModel(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group);

  Teuchos::RCP<const Map> rows() const override { return domain_.rows; }
  Teuchos::RCP<const Map> sources() const override { return domain_.sources; }
  std::vector<Field> fields() const override { return {{"temperature", "K"}}; }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  ConstPositionView positions() const override { return domain_.positions; }

  /// As the report has it: derivatives of the material's properties are left out.
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;
  /// With the derivatives of the material's properties.
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const override;
  /// With the derivatives of the material's properties. The first call sets up the graph and is collective.
  Teuchos::RCP<const CrsMatrix> rate_jacobian_matrix(ConstVectorView u, double time) const override;

  std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const override;
  void save_sample(hdf5::Group& group) const override;

  /// w_ij = m_j r_ij·∇W_ij/r_ij² in kg/m⁵: what is left of a pair's term depends on two temperatures alone.
  PairWeights pair_weights(const std::vector<GlobalIndex>& rows) const override;
  std::unique_ptr<Model> clustered(const SourceClusters& clusters) const override;

  /// Points go through the particles and their pairs as the lanes of vectors: neighbours and weights are read once for
  /// eight points.
  std::unique_ptr<PointRates> at_points(const ParameterPoints& points) override;

  /// `pairs`: directed pairs of neighbours, and `neighbours_per_particle`.
  std::vector<std::pair<std::string, double>> facts() const override;

  void begin_run() override;
  /// `mean_absorbed_watt` over the times of the run; none of a source that does not heat.
  std::vector<std::pair<std::string, double>> run_facts() const override;
  /// Where a source that heats has heated no particle.
  std::vector<std::string> warnings() const override;

  /// Particles, pairs and weights of this rank.
  const HeatDomain& domain() const { return domain_; }
  const MaterialTable& material() const { return table_; }
  /// How this rank's pairs lie in memory.
  const PairLayout& layout() const { return *layout_; }

 private:
  HeatModel(const Teuchos::ParameterList& list, const Context& context, const MaterialTable& table);
  HeatModel(const Teuchos::ParameterList& list, const MaterialTable& table, HeatDomain domain);
  /// This model on another domain, its live parameters as they are.
  std::unique_ptr<HeatModel> on(HeatDomain domain) const;
  LocalIndex row_count() const { return static_cast<LocalIndex>(domain_.areas.extent(0)); }
  LocalIndex source_count() const { return static_cast<LocalIndex>(domain_.masses.extent(0)); }
  void check(const char* method, std::size_t u, std::size_t f) const;
  /// Fills states_ from temperatures, if they are not those of the last call.
  void update_states(const ConstVectorView& of_sources) const;
  /// Fills states_, slopes_ and absorbed_.
  void linearise(ConstVectorView u, double time) const;
  /// Fills absorbed_ at the heated rows, if it is not that of this time and of the source's parameters as they are: one
  /// evaluation of the source serves all iterations of a step.
  void update_absorbed(double time) const;
  /// W, over all ranks; nothing where no rate has been asked for. Collective.
  std::optional<double> mean_absorbed() const;
  /// Columns first_column … of `product`, at most Width.
  template <int Width>
  void apply_columns(ConstMatrixView v, MatrixView product, int first_column) const;
  void make_matrix() const;

  /// d/du of the fields of a ThermalState besides the temperature.
  struct ThermalSlopes {
    double resistivity;
    double volume;
    double specific_heat;
  };

  class AtPoints;
  struct JacobianRow;
  struct JacobianRows;
  /// Columns of a multivector that go through the pairs together.
  static constexpr int block_width = 8;
  using PackedView = Kokkos::View<double* [block_width], Kokkos::LayoutRight, Device>;

  Teuchos::ParameterList list_;
  MaterialTable table_;
  HeatDomain domain_;
  std::unique_ptr<PairLayout> layout_;
  double initial_temperature_;
  std::unique_ptr<HeatSource> heat_source_;
  IndexView heated_;  ///< rows with a heated area
  PositionView heated_positions_;

  // Work arrays: the sampled model is evaluated millions of times and must not allocate.
  VectorView heated_flux_;  ///< q in W/m² at heated_
  VectorView absorbed_;     ///< q_i A_i in W of every row, of absorbed_of_ and absorbed_time_
  mutable LastParameters absorbed_of_;
  mutable double absorbed_time_ = std::numeric_limits<double>::quiet_NaN();
  bool adds_absorbed_ = false;            ///< the full model: of samples it says little and costs as much as their sums
  mutable double absorbed_sum_ = 0.0;     ///< W: of this rank's rows, over the times of the run so far
  mutable long long absorbed_times_ = 0;  ///< how many these are
  ThermalStateView states_;               ///< of the sources and, last, nobody
  mutable LastState states_of_;           ///< whose states_ they are
  VectorView fluxes_;                     ///< pair sums of every row
  mutable bool fluxes_hold_ = false;      ///< whether fluxes_ are those of states_
  VectorView conductances_;               ///< pair sums of every row
  mutable Kokkos::View<ThermalSlopes*, Device> slopes_;  ///< made by the first Jacobian
  mutable PackedView packed_;
  mutable Teuchos::RCP<CrsMatrix> matrix_;
  mutable OffsetView matrix_slots_;  ///< where each pair's entry stands in the matrix's values
  mutable OffsetView diagonal_slots_;
};

}  // namespace kiln
