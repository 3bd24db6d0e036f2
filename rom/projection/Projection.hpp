#pragma once

#include <functional>
#include <memory>
#include <string>

#include "framework/method/StepResidual.hpp"
#include "framework/model/Model.hpp"
#include "framework/solvers/JacobianAction.hpp"
#include "framework/solvers/NewtonSettings.hpp"
#include "rom/basis/TrialSpace.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/projection/TestBasis.hpp"

namespace kiln {

namespace hdf5 {
class Group;
}

/// The reduced equations of one time window: its coordinates û in a trial space g, found from
///
///     Ψᵀ r(g(û)) = 0,   by û ← û − (Ψᵀ J̃Φ)⁻¹ Ψᵀ r,   J̃Φ = (α0 I − γ ∂f/∂u) ∂g/∂û at the model's rows,
///
/// with Ψ a TestBasis: Galerkin, LSPG (Alg. 1 without hyper-reduction) or GNAT (Alg. 1). The model may be the full one
/// or a sampled one. Every rank holds all of û, computes the state of its sources from it and adds up one vector of M
/// numbers an iteration; nothing else is communicated. J̃Φ, Ψ and the factors of Ψᵀ J̃Φ are kept for `refresh` steps;
/// with them kept, an iteration allocates nothing.
///
/// Convergence: ‖Ψᵀr‖₂ relative to its first value of the step (Alg. 1, line 10).
///
/// All x are coordinates of all time windows, of which a projection changes its own.
class Projection {
 public:
  struct Parts {
    std::shared_ptr<Model> model;
    std::shared_ptr<const TrialSpace> trial;  ///< on the model's sources
    std::unique_ptr<TestBasis> test;          ///< on its rows
  };

  /// When Ψ and the factors of Ψᵀ J̃Φ are formed.
  enum class Factors {
    kept,            ///< with each new J̃Φ
    every_iteration  ///< in each iteration anew from the same J̃Φ, as Algorithm 1 is printed: dearer, and no other
                     ///< result
  };

  /// A residual this many times the step's first one will not come back.
  static constexpr double growth_limit = 1e6;
  static constexpr const char* not_finite = "the residual is not finite";
  static constexpr const char* grown = "the reduced residual has grown a million times in one step";

  Projection(Parts parts, const NewtonSettings& settings, Factors factors = Factors::kept);

  Model& model() const { return *model_; }
  const TrialSpace& trial() const { return *trial_; }
  TestBasis& test_basis() const { return *test_basis_; }
  const NewtonSettings& settings() const { return settings_; }
  Factors when_factored() const { return when_factored_; }
  LocalIndex row_size() const { return row_size_; }
  /// û whose state is nearest to the model's initial one at the rows; exactly 0 where that is the reference state.
  void initial(VectorView x) const;

  /// As the functions of Method.
  void evaluate(ConstVectorView x, double time, VectorView u, VectorView f);
  /// dû/dt = (Ψ0ᵀΦ)⁻¹ Ψ0ᵀ f, where Ψ0 is the test basis for J̃ = I; zero for the coordinates of other windows.
  int rate(ConstVectorView x, double time, VectorView dxdt);
  SolveReport solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f);
  void require_jacobian() const;

  /// Throws DivergenceError for a reduced Jacobian of this reciprocal condition number that is singular to round-off.
  static void require_regular(double reciprocal_condition, double time);
  /// The next step takes J̃Φ anew.
  void forget_jacobian() { frozen_.age = -1; }
  long long linearisations() const { return linearisations_; }
  double reciprocal_condition() const { return reciprocal_condition_; }

  /// The point J̃Φ was taken at. `x_size`: length of x.
  void save(hdf5::Group& group) const;
  void restore(const hdf5::Group& group, std::size_t x_size);

  /// Called with the residual at the rows, rows × components, of every iteration, and with the rate of every explicit
  /// stage: how residual snapshots are taken.
  void observe_residuals(std::function<void(ConstVectorView)> observer) { observer_ = std::move(observer); }

  /// What ‖Ψᵀr‖ is to fall to: the tolerance of what it was first, or the round-off of its own terms, ‖Ψ‖_F ‖h‖ ε,
  /// which no update can bring it below.
  static double goal(double tolerance, double first_norm, double test_norm, double history_norm);

 private:
  void linearise(double alpha, double gamma, ConstVectorView x, double time);
  /// Ψ and the factors of Ψᵀ J̃Φ, from J̃Φ.
  void factor(double time);
  bool linearised_for(double alpha, double gamma) const;
  /// Evaluates state and rate for x; f: rows × components. Fills residual_ and g_ = Ψᵀr; returns ‖g_‖, which may not be
  /// finite.
  double reduced_residual(const StepResidual& residual, ConstVectorView x, VectorView f);
  void project(const VectorView& rows, const VectorView& g);
  /// û ← û + scale · step_.
  void move(VectorView x, double scale) const;
  /// The step of an explicit scheme in an affine trial space, linear in û: one update, one evaluation of f.
  SolveReport solve_explicit(const StepResidual& residual, VectorView x, VectorView u, VectorView f);
  /// Halves the update until ‖Ψᵀr‖ falls below `norm`, NewtonSettings::halvings times at most; x already holds x −
  /// step_. Returns the new norm.
  double search_line(const StepResidual& residual, VectorView x, VectorView f, double norm, double next,
                     SolveReport& report);
  [[noreturn]] void throw_diverged(const std::string& what, double time, ConstVectorView f,
                                   ConstVectorView measure) const;

  std::shared_ptr<Model> model_;
  std::shared_ptr<const TrialSpace> trial_;
  std::unique_ptr<TestBasis> test_basis_;
  NewtonSettings settings_;
  Teuchos::RCP<const Communicator> communicator_;
  LocalIndex row_size_;
  int first_, size_;
  Factors when_factored_;
  JacobianAction jacobian_;
  std::function<void(ConstVectorView)> observer_;

  /// The point J̃Φ was taken at; a restart takes it there again.
  struct Frozen {
    VectorView x;
    double alpha = 0.0, gamma = 0.0, time = 0.0;
    int age = -1;  ///< steps it has served; −1: not taken yet
  } frozen_;
  ConstMatrixView tangent_rows_;  ///< Φ where J̃Φ was taken
  MatrixView jacobian_tangent_;   ///< J̃Φ
  MatrixView small_;              ///< Ψᵀ J̃Φ, overwritten by its factors
  ConstMatrixView test_;          ///< Ψ
  double test_norm_ = 0.0;        ///< ‖Ψ‖_F over all ranks
  dense::LuFactors factors_;
  double reciprocal_condition_ = 1.0;
  long long linearisations_ = 0;

  VectorView state_;               ///< sources × components
  VectorView rate_, residual_;     ///< rows × components
  VectorView g_, local_g_, step_;  ///< M
};

}  // namespace kiln
