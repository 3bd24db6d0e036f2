#pragma once

#include "framework/model/Model.hpp"
#include "framework/model/PairwiseModel.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln::test {

/// A chain of N particles on [0, 1] that diffuse to their nearest and second nearest neighbours, react and are heated
/// by a moving source; with two components a second field is coupled to the first:
///
///     du/dt = D Σ_j w_ij (u_j − u_i) − R u³ + P exp(−((x − v t)/0.1)²) [+ 0.3 w]
///     dw/dt = D/2 Σ_j w_ij (w_j − w_i) − 0.5 u
///
/// w_ij is 1 for neighbours and 1/4 for second neighbours. Everything is computed from a particle's id, so that nothing
/// of size N is held by a sample. Its pairs are linear in their sources, so that clusters with the pairs' own weights
/// change nothing. Registered as model "test chain".
class Chain : public Model, public PairwiseModel {
 public:
  static Specification specification();
  Chain(const Teuchos::ParameterList& list, const Context& context);
  /// Restores a sample.
  Chain(const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group);

  Teuchos::RCP<const Map> rows() const override { return rows_; }
  Teuchos::RCP<const Map> sources() const override { return sources_; }
  std::vector<Field> fields() const override;
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  ConstPositionView positions() const override { return positions_; }
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const override;
  std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const override;
  void save_sample(hdf5::Group& group) const override;
  PairWeights pair_weights(const std::vector<GlobalIndex>& rows) const override;
  std::unique_ptr<Model> clustered(const SourceClusters& clusters) const override;

 private:
  /// What a chain of clustered sources cannot compute from ids: the same on every rank.
  struct Clustered {
    std::vector<std::size_t> offsets;        ///< one more than all_rows_
    std::vector<GlobalIndex> sources;        ///< ids of clusters, of each pair
    std::vector<double> weights, positions;  ///< of each pair; of each cluster
  };

  Chain(const Chain& full, const std::vector<GlobalIndex>& rows, std::shared_ptr<const Clustered> clustered);
  void read(const Teuchos::ParameterList& list);
  void list_parameters();
  void build(const std::vector<GlobalIndex>& mine, const Teuchos::RCP<const Communicator>& communicator);
  /// Sources of a row, with their weights.
  std::vector<std::pair<GlobalIndex, double>> pairs_of(GlobalIndex row) const;
  double position(GlobalIndex particle) const;

  int count_ = 0, components_ = 1;
  double diffusion_ = 0.0, reaction_ = 0.0, power_ = 0.0, velocity_ = 0.0, offset_ = 0.0;
  std::vector<GlobalIndex> all_rows_;
  Teuchos::RCP<const Map> rows_, sources_;
  PositionView positions_;
  std::shared_ptr<const Clustered> clustered_;  ///< null: particles are the sources
  std::vector<std::size_t> offsets_{0};         ///< where each row's pairs begin
  std::vector<LocalIndex> neighbours_;
  std::vector<double> weights_;
};

/// The chain as a model that offers nothing but what every model must, and positions. Registered as "test rate only".
class RateOnly : public Model {
 public:
  static Specification specification() { return Chain::specification(); }
  RateOnly(const Teuchos::ParameterList& list, const Context& context) : chain_(list, context) {}
  Teuchos::RCP<const Map> rows() const override { return chain_.rows(); }
  Teuchos::RCP<const Map> sources() const override { return chain_.sources(); }
  std::vector<Field> fields() const override { return chain_.fields(); }
  void initial_state(VectorView u) const override { chain_.initial_state(u); }
  void rate(ConstVectorView u, double time, VectorView f) const override { chain_.rate(u, time, f); }
  ConstPositionView positions() const override { return chain_.positions(); }

 private:
  Chain chain_;
};

/// What a test sets; the rest of a whole input is filled in.
struct Case {
  std::string model = "test chain";
  int count = 60;
  int components = 1;
  double power = 40.0;
  double reaction = 2.0;
  double step = 0.002;
  int steps = 40;
  std::string scheme = "backward euler";
  std::string method = "fom";
  double tolerance = 1e-12;
  double linear_tolerance = 1e-12;
  int iterations = 20;
  int refresh = 1;
  std::string jacobian = "matrix free";
  int basis_rank = 10, residual_rank = 12, samples = 24;
  int snapshots_every = 1;
  int snapshots_hold = 0;  ///< 0: all
  std::string algorithm = "gram";
  std::string clustering = "";             ///< empty: the block is left out
  int clusters = 2;                        ///< of type "per row"
  std::string cluster_weights = "fitted";  ///< likewise
  int windows = 0;                         ///< 0: the block is left out
  double window_error = 0.0;               ///< likewise
  std::vector<double> train_on, try_on;    ///< powers; empty: the block is left out
  std::string folder = ".";
};

/// A checked input as `kiln run` and `kiln train` would hand it to methods and trainers.
Teuchos::ParameterList input_of(const Case& values);

Teuchos::RCP<const Communicator> world();
/// A communicator of this rank alone: what one rank computes is the yardstick for several.
Teuchos::RCP<const Communicator> self();

}  // namespace kiln::test
