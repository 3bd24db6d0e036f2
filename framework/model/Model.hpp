#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/Field.hpp"
#include "framework/base/LinearAlgebra.hpp"
#include "framework/model/ParameterPoints.hpp"
#include "framework/model/Parameters.hpp"

namespace kiln {

namespace hdf5 {
class Group;
}

class PointRates;

/// A full-order model: the semi-discrete system du/dt = f(u, t; µ) of Eq. 12, on this rank's rows.
///
/// A model evaluates f on its *rows* (particles this rank answers for) from the state of its *sources* (the rows, in
/// the same order and first, then every other particle they need). Who fills the state of the sources is not the
/// model's concern: the full-order method imports it from other ranks, a reduced one computes it from its coordinates.
/// So one and the same physics serves the whole domain and a sample mesh, and
///
///     rate(u[sources])[rows] == sampled(rows)->rate(u[its sources])
///
/// holds for every model; a generic test executes it on each registered one.
///
/// Arrays hold `components` values a particle, particle by particle. All rates are per second.
/// New physics must implement the first five functions; what else it does not offer throws NotOffered.
class Model {
 public:
  struct Context {
    Teuchos::RCP<const Communicator> communicator;
  };
  static constexpr const char* category = "model";

  virtual ~Model() = default;

  /// Particles whose rate this rank evaluates; over all ranks each appears once.
  virtual Teuchos::RCP<const Map> rows() const = 0;
  /// Particles whose state `rate` reads on this rank: rows() first, in the same order, then the others.
  virtual Teuchos::RCP<const Map> sources() const = 0;
  /// The components of a particle's state, in the order in which arrays hold them.
  virtual std::vector<Field> fields() const = 0;
  /// State at t = 0 of every source. u: sources × components.
  virtual void initial_state(VectorView u) const = 0;
  /// f(u, t; µ) of Eq. 11. u: sources × components; f: rows × components, overwritten.
  virtual void rate(ConstVectorView u, double time, VectorView f) const = 0;

  /// Positions of the sources in metres, for probes, pictures and files.
  virtual ConstPositionView positions() const;

  /// Diagonal of ∂f/∂u at the rows. diagonal: rows × components, overwritten.
  virtual void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const;
  /// (∂f/∂u) V: what matrix-free solvers and reductions need. v: sources × components by k; product: rows ×
  /// components by k, overwritten.
  virtual void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const;
  /// ∂f/∂u as a sparse matrix over rows and sources (degree_of_freedom_map of both; its domain is the full rows').
  /// Every row's graph holds the diagonal. The matrix stays the model's and is refilled by the next call, if possible
  /// with the same graph.
  virtual Teuchos::RCP<const CrsMatrix> rate_jacobian_matrix(ConstVectorView u, double time) const;

  /// The same physics on chosen rows only, with just the sources these need. `rows` holds global particle ids and is
  /// the same on every rank; a rank of the result keeps those of its own rows, in ascending order of ids. Throws
  /// InputError for an id that is there twice or that is no row.
  virtual std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const;
  /// Writes what a sampled model needs to be rebuilt without the full one, for any number of ranks. Collective.
  virtual void save_sample(hdf5::Group& group) const;

  /// This model at several points of its live parameters at once. The result uses the model and must not outlive it.
  /// Unless a model has something faster, the points are evaluated one after the other.
  virtual std::unique_ptr<PointRates> at_points(const ParameterPoints& points);

  /// What the run report should say of the model, e.g. {"pairs", 7871920}, over all ranks. A model that has nothing to
  /// add to what its method reports anyway keeps the empty list. Collective.
  virtual std::vector<std::pair<std::string, double>> facts() const { return {}; }

  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }

 protected:
  Parameters parameters_;

 private:
  std::string class_name() const;
};

}  // namespace kiln
