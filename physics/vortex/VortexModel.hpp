#pragma once

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <string>
#include <vector>

#include "framework/model/LastParameters.hpp"
#include "framework/model/LastState.hpp"
#include "framework/model/Model.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "framework/registry/Specification.hpp"
#include "physics/vortex/VortexKernel.hpp"
#include "physics/vortex/VortexSum.hpp"
#include "physics/vortex/VortexTable.hpp"

namespace kiln {

/// Vortex particles in the plane, moved by the velocity they induce on one another (Biot–Savart):
///
///     dx_i/dt = µ Σ_j Γ_j K(x_i − x_j),   K(r) = q(|r|²) r⊥/(2π),
///
/// with circulations Γ that stay as they are, a regularised kernel K and the factor µ = circulation_scale. The state of
/// a particle is its place; a particle does not move itself. Rows are dealt out to the ranks in blocks of ids; every
/// particle is a source of every row. Sums run through the sources in the order of their ids: the number of ranks
/// changes no more than their rounding.
///
/// Evaluations write to work arrays the model keeps: one evaluation at a time.
class VortexModel final : public Model, public PairwiseModel {
 public:
  static Specification specification();
  VortexModel(const Teuchos::ParameterList& list, const Context& context);
  /// From a group written by save_sample. `list` is the model's own checked block; the particles are not read again.
  VortexModel(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group);

  Teuchos::RCP<const Map> rows() const override { return rows_; }
  Teuchos::RCP<const Map> sources() const override { return sources_; }
  std::vector<Field> fields() const override {
    return {{"x", "m", /*origin_is_free=*/true}, {"y", "m", /*origin_is_free=*/true}};
  }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  /// At t = 0; z = 0.
  ConstPositionView positions() const override { return positions_; }

  /// Jacobians are the direct sum's, whatever sum the rate is formed by.
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const override;

  /// Chosen rows with all particles as their sources.
  std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const override;
  void save_sample(hdf5::Group& group) const override;

  /// w_ij = Γ_j of every other particle j.
  PairWeights pair_weights(const std::vector<GlobalIndex>& rows) const override;
  std::unique_ptr<Model> clustered(const SourceClusters& clusters) const override;

  /// `pairs`: of a direct sum, over all ranks.
  std::vector<std::pair<std::string, double>> facts() const override;

 private:
  VortexModel(const Teuchos::ParameterList& list, const Teuchos::RCP<const Communicator>& communicator,
              VortexTable table, const std::vector<GlobalIndex>& own_rows);
  VortexModel(const Teuchos::ParameterList& list, const Teuchos::RCP<const Communicator>& communicator,
              VortexTable table);
  /// The model on `table` with this one's parameters; each row stays on its rank.
  std::unique_ptr<Model> on_table(VortexTable table) const;
  void make_lists(const std::vector<GlobalIndex>& own_rows, const std::vector<GlobalIndex>& own_sources);
  void make_arrays(const std::vector<GlobalIndex>& own_sources);

  LocalIndex row_count() const { return row_count_; }
  LocalIndex source_count() const { return static_cast<LocalIndex>(positions_.extent(0)); }
  void check(const char* method, std::size_t u, std::size_t f) const;
  void require_no_lists(const char* method) const;
  void sum_velocities(ConstVectorView u, VectorView f) const;
  /// Fills arrays_ from a state.
  void arrange(ConstVectorView u) const;
  VortexArrays arrays() const;
  VortexLists lists(ConstVectorView u) const;
  /// µ/(2π).
  double factor() const;

  using Indices = Kokkos::View<LocalIndex*, Device>;
  using Offsets = Kokkos::View<std::size_t*, Device>;

  Teuchos::ParameterList list_;
  VortexTable table_;
  Teuchos::RCP<const Map> rows_, sources_;
  LocalIndex row_count_;
  PositionView positions_;
  std::unique_ptr<VortexKernel> kernel_;
  std::unique_ptr<VortexSum> sum_;
  double circulation_scale_;
  mutable LastState last_state_;            ///< that last_rate_ is the rate of
  mutable LastParameters last_parameters_;  ///< likewise
  VectorView last_rate_;

  // Where every source acts on every row: sources by id, up to a multiple of the lanes.
  LocalIndex array_count_ = 0, array_padded_ = 0;
  VectorView array_x_, array_y_, array_circulations_;
  Indices places_;                            ///< of each source in the arrays
  mutable MatrixView tangent_x_, tangent_y_;  ///< as the arrays, a column a tangent
  // Where rows have lists.
  Offsets list_offsets_;
  Indices list_sources_;
  VectorView list_circulations_;
};

}  // namespace kiln
