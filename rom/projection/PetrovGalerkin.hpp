#pragma once

#include <functional>
#include <string>

#include "framework/method/Method.hpp"
#include "framework/time/JacobianAction.hpp"
#include "framework/time/NewtonSettings.hpp"
#include "rom/basis/TrialSpace.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/projection/TestBasis.hpp"

namespace kiln {

/// A reduced method: the generalised coordinates û of a trial space g, found from
///
///     Ψᵀ r(g(û)) = 0,   by û ← û − (Ψᵀ J̃Φ)⁻¹ Ψᵀ r,   J̃Φ = (α0 I − γ ∂f/∂u) ∂g/∂û at the model's rows,
///
/// with Ψ a TestBasis: Galerkin, LSPG (Alg. 1 without hyper-reduction) or GNAT (Alg. 1). The model may be the full one
/// or a sampled one. Every rank holds all of û, computes the state of its sources from it and adds up one vector of M
/// numbers an iteration; nothing else is communicated. J̃Φ, Ψ and the factors of Ψᵀ J̃Φ are kept for `refresh` steps;
/// with them kept, an iteration allocates nothing.
///
/// Convergence: ‖Ψᵀr‖₂ relative to its first value of the step (Alg. 1, line 10).
class PetrovGalerkin : public Method {
 public:
  /// The particles whose state the method tells, each on one rank, and the trial space there.
  struct Held {
    Teuchos::RCP<const Map> particles;
    ConstPositionView positions;
    std::unique_ptr<TrialSpace> trial;
  };

  /// What a projection is made of.
  struct Parts {
    std::shared_ptr<Model> model;
    std::unique_ptr<TrialSpace> trial;  ///< on the model's sources
    std::unique_ptr<TestBasis> test;    ///< on its rows
    Held held;
  };

  PetrovGalerkin(Parts parts, const NewtonSettings& settings);

  Teuchos::RCP<const Map> coordinates() const override { return coordinates_; }
  LocalIndex row_size() const override { return row_size_; }
  /// û whose state is nearest to the model's initial one at the rows; exactly 0 where that is the reference state.
  void initial(VectorView x) const override;

  void evaluate(ConstVectorView x, double time, VectorView u, VectorView f) override;
  /// dû/dt = (Ψ0ᵀΦ)⁻¹ Ψ0ᵀ f, where Ψ0 is the test basis for J̃ = I.
  int rate(ConstVectorView x, double time, VectorView dxdt) override;
  SolveReport solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) override;

  Teuchos::RCP<const Map> particles() const override { return held_.particles; }
  ConstPositionView positions() const override { return held_.positions; }
  std::vector<Field> fields() const override { return model_->fields(); }
  void state(ConstVectorView x, VectorView u) const override { held_.trial->state(x, u); }
  Parameters& parameters() override { return model_->parameters(); }

  void save(hdf5::Group& group) const override;
  void restore(const hdf5::Group& group) override;
  void report(nlohmann::json& section) const override;

  /// Called with the residual at the rows, rows × components, of every iteration, and with the rate of every explicit
  /// stage: how residual snapshots are taken.
  void observe_residuals(std::function<void(ConstVectorView)> observer) { observer_ = std::move(observer); }

 private:
  void linearise(double alpha, double gamma, ConstVectorView x, double time);
  bool linearised_for(double alpha, double gamma) const;
  /// Evaluates state and rate for x; f: rows × components. Fills residual_ and g_ = Ψᵀr; returns ‖g_‖.
  double reduced_residual(const StepResidual& residual, ConstVectorView x, VectorView f);
  void project(ConstVectorView rows, VectorView g);
  /// The step of an explicit scheme in an affine trial space, linear in û: one update, one evaluation of f.
  SolveReport solve_explicit(const StepResidual& residual, VectorView x, VectorView u, VectorView f);
  /// Halves the update until ‖Ψᵀr‖ falls below `norm`; x already holds x − step_. Returns the new norm.
  double search_line(const StepResidual& residual, VectorView x, VectorView f, double norm, double next,
                     SolveReport& report);
  [[noreturn]] void throw_diverged(const std::string& what, double time, ConstVectorView f,
                                   ConstVectorView measure) const;

  std::shared_ptr<Model> model_;
  std::unique_ptr<TrialSpace> trial_;
  std::unique_ptr<TestBasis> test_basis_;
  Held held_;
  NewtonSettings settings_;
  Teuchos::RCP<const Communicator> communicator_;
  Teuchos::RCP<const Map> coordinates_;
  LocalIndex row_size_;
  JacobianAction jacobian_;
  std::function<void(ConstVectorView)> observer_;

  /// The point J̃Φ was taken at; a restart takes it there again.
  struct Frozen {
    VectorView x;
    double alpha = 0.0, gamma = 0.0, time = 0.0;
    int age = -1;  ///< steps it has served; −1: not taken yet
  } frozen_;
  MatrixView jacobian_tangent_;  ///< J̃Φ
  MatrixView small_;             ///< Ψᵀ J̃Φ, overwritten by its factors
  ConstMatrixView test_;         ///< Ψ
  dense::LuFactors factors_;
  double reciprocal_condition_ = 1.0;
  long long linearisations_ = 0;

  VectorView state_;               ///< sources × components
  VectorView rate_, residual_;     ///< rows × components
  VectorView g_, local_g_, step_;  ///< M
};

}  // namespace kiln
