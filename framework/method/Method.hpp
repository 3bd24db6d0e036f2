#pragma once

#include <array>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/base/LinearAlgebra.hpp"
#include "framework/base/NearestParticle.hpp"
#include "framework/method/StepResidual.hpp"
#include "framework/model/Model.hpp"

namespace Teuchos {
class ParameterList;
}

namespace kiln {

namespace hdf5 {
class Group;
}

/// How the unknowns of a model are represented and solved for: the full-order state itself, or generalised
/// coordinates of a trial space. `method: {type: …}` in the input picks one; time schemes, the driver and observers
/// know this interface only.
///
/// The unknown x is the local part of a vector over coordinates(): this rank's rows of u (full order), or all M
/// coordinates û, the same on every rank (reduced). `evaluate` turns x into the state and rate at this rank's rows,
/// where time schemes keep their history (StepResidual).
class Method {
 public:
  struct Context {
    const Teuchos::ParameterList& input;  ///< the whole checked input
    Teuchos::RCP<const Communicator> communicator;
  };
  static constexpr const char* category = "method";

  virtual ~Method() = default;

  /// Map of the unknown x. Reduced methods return a locally replicated map.
  virtual Teuchos::RCP<const Map> coordinates() const = 0;
  /// Length of this rank's part of a row-space vector: rows × components.
  virtual LocalIndex row_size() const = 0;
  /// x at t = 0.
  virtual void initial(VectorView x) const = 0;
  /// Forgets what earlier steps have left, as frozen Jacobians and the current time window: what follows is bit by bit
  /// what it would be with a method just made. Collective.
  virtual void forget() = 0;

  /// Prepares for a step that ends at `time`; steps come in the order of time. Returns whether the rows are others than
  /// before, as where a new time window has a sample mesh of its own: row_size() may have changed, and states and rates
  /// that were kept at the rows must be evaluated anew from their x. Collective.
  virtual bool begin_step(double time) = 0;

  /// u and f(u, t) at this rank's rows for the unknown x.
  virtual void evaluate(ConstVectorView x, double time, VectorView u, VectorView f) = 0;
  /// dx/dt, for explicit Runge–Kutta stages. Returns the number of evaluations of f.
  virtual int rate(ConstVectorView x, double time, VectorView dxdt) = 0;
  /// Solves r(x) = 0, exactly or in the method's own sense, from the guess in x. On return x is the solution and
  /// u, f hold state and rate at this rank's rows there. Throws DivergenceError without step number; the loop over
  /// the steps adds it.
  virtual SolveReport solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) = 0;
  /// Throws NotOffered for a form of the Jacobian that an implicit solve() is to use and the model lacks. Schemes with
  /// implicit steps ask when they are made, before a run replaces what an earlier one left. A frozen Jacobian may be
  /// lost. Collective.
  virtual void require_jacobian() = 0;

  /// Particles whose state can be told on this rank, each on exactly one rank. Full order: all; hyper-reduced: the
  /// sample mesh and the queried particles.
  virtual Teuchos::RCP<const Map> particles() const = 0;
  /// Positions in metres of particles(), in its order.
  virtual ConstPositionView positions() const = 0;
  /// The particle that a question about a point (m) is about: the nearest one of the whole model. Its id is −1 where it
  /// is not among particles(), or not known to be. Collective.
  virtual NearestParticle nearest(const std::array<double, 3>& point) const = 0;
  /// Components of a particle's state.
  virtual std::vector<Field> fields() const = 0;
  /// State of particles() for the unknown x. u: particles × components.
  virtual void state(ConstVectorView x, VectorView u) const = 0;
  /// Tells some of particles(), given by their local places, as state() does but at the cost of these alone: the
  /// function returned fills u, places × components, for the unknown x. It must not outlive the method.
  using Reader = std::function<void(ConstVectorView x, VectorView u)>;
  virtual Reader reader(const std::vector<LocalIndex>& places) const = 0;

  virtual Parameters& parameters() = 0;

  /// What a bitwise restart needs besides x and the scheme's history: the point a frozen Jacobian was taken at.
  virtual void save(hdf5::Group& group) const = 0;
  virtual void restore(const hdf5::Group& group) = 0;

  /// What a user is to know before the answers so far, to the parameters of now, are believed, a sentence each. The
  /// same on every rank. Collective.
  virtual std::vector<std::string> warnings() const = 0;
  /// The method's own lines of the run report, e.g. basis rank and sampled particles.
  virtual void report(nlohmann::json& section) const = 0;
  /// More of them, of a single run: what its solves have counted, since it began or was continued.
  virtual void report_work(nlohmann::json& section) const = 0;
};

}  // namespace kiln
