#pragma once

#include <memory>
#include <vector>

#include "framework/model/Model.hpp"

namespace kiln {

/// The sampled model of any model: evaluates the full one and keeps chosen rows. Every evaluation costs as much as the
/// full model's, and every array behind it is of the full size N: this is for physics that offers `rate` alone, and for
/// tests of models that sample themselves. Jacobian forms are passed through where the full model offers them.
///
/// The sources are those of the full model: the chosen rows first, then the rest in the full model's order. The full
/// model is shared and so are its live parameters: a value set here is set there.
class MaskedModel : public Model {
 public:
  /// `rows` as for Model::sampled. Throws std::invalid_argument for an id that is no row of the full model, or one
  /// listed twice. Collective.
  MaskedModel(std::shared_ptr<const Model> full, const std::vector<GlobalIndex>& rows);

  Teuchos::RCP<const Map> rows() const override { return rows_; }
  Teuchos::RCP<const Map> sources() const override { return sources_; }
  std::vector<Field> fields() const override { return full_->fields(); }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  ConstPositionView positions() const override;
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const override;
  Teuchos::RCP<const CrsMatrix> rate_jacobian_matrix(ConstVectorView u, double time) const override;
  std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const override;
  /// Writes the ids of the rows: to rebuild this model, the full one must be built first.
  void save_sample(hdf5::Group& group) const override;

 private:
  using Indices = Kokkos::View<LocalIndex*, Device>;

  std::shared_ptr<const Model> full_;
  std::vector<GlobalIndex> chosen_;  ///< of all ranks, ascending
  Teuchos::RCP<const Map> rows_, sources_;
  std::size_t components_;
  Indices full_source_;  ///< the full model's place of each entry of this model's sources × components
  // The full model's arrays, kept from one evaluation to the next.
  MatrixView full_state_, full_rate_;  ///< of one column
  mutable MatrixView full_vectors_, full_products_;
};

/// full->sampled(rows), or a MaskedModel where the full model does not offer it. Ownership: a MaskedModel keeps `full`
/// alive; a model that samples itself does not need it.
std::unique_ptr<Model> sampled_or_masked(const std::shared_ptr<const Model>& full,
                                         const std::vector<GlobalIndex>& rows);

}  // namespace kiln
