#pragma once

#include <memory>

#include "framework/method/Method.hpp"
#include "framework/model/Halo.hpp"
#include "framework/solvers/NewtonSettings.hpp"
#include "framework/solvers/StepJacobian.hpp"

namespace kiln {

/// The full-order method: the unknown is the state itself. An implicit step is solved by inexact Newton,
///
///     (α0 I − γ ∂f/∂u) δ = −r(u),   u ← u + s δ,
///
/// with ∂f/∂u frozen for `refresh` steps. It stops at ‖r‖ ≤ tolerance · ‖r before the first update of the step‖ (2-norm
/// over all ranks), when r is down to the round-off of its own terms, or at the cap of updates. With a line search, s
/// is halved until the norm falls; an update that no halving saves is kept at its shortest and ends the step
/// unconverged.
class FullOrder : public Method {
 public:
  /// A norm this many times the first one of its step is divergence.
  static constexpr double divergence_growth = 1e6;

  static Specification specification();
  /// Creates the model of the block `model` and reads `time.newton`.
  FullOrder(const Teuchos::ParameterList& block, const Context& context);
  /// Takes a model that is there. `solver` may be null for a diagonal Jacobian.
  FullOrder(std::shared_ptr<Model> model, const NewtonSettings& settings,
            std::shared_ptr<LinearSolver> solver = nullptr);

  Teuchos::RCP<const Map> coordinates() const override { return halo_.rows(); }
  LocalIndex row_size() const override { return halo_.row_size(); }
  void initial(VectorView x) const override;
  void forget() override;
  bool begin_step(double) override { return false; }

  void evaluate(ConstVectorView x, double time, VectorView u, VectorView f) override;
  /// Throws DivergenceError for a rate that is not finite.
  int rate(ConstVectorView x, double time, VectorView dxdt) override;
  /// Throws DivergenceError for a residual that is not finite or grows beyond `divergence_growth`, and for a linear
  /// solve that fails.
  SolveReport solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) override;
  void require_jacobian() override;

  Teuchos::RCP<const Map> particles() const override { return model_->rows(); }
  ConstPositionView positions() const override;
  NearestParticle nearest(const std::array<double, 3>& point) const override;
  std::vector<Field> fields() const override { return model_->fields(); }
  void state(ConstVectorView x, VectorView u) const override;
  Reader reader(const std::vector<LocalIndex>& places) const override;
  Parameters& parameters() override { return model_->parameters(); }

  void save(hdf5::Group& group) const override;
  void restore(const hdf5::Group& group) override;
  /// The model's; none of a run that was continued, of which it has seen the last part only.
  std::vector<std::string> warnings() const override;
  void report(nlohmann::json& section) const override;
  void report_work(nlohmann::json& section) const override;

  const std::shared_ptr<Model>& model() const { return model_; }
  /// Times ∂f/∂u was evaluated, a restart's recomputation included.
  int jacobian_evaluations() const { return jacobian_evaluations_; }

 private:
  /// Fills the sources from x and evaluates f there.
  void rate_at(ConstVectorView x, double time, VectorView f);
  /// Evaluates f(x) and residual_ = r(x); returns the residual's norm.
  double norm_at(const StepResidual& residual, ConstVectorView x, VectorView f);
  SolveReport solve_explicit(const StepResidual& residual, VectorView x, VectorView f);
  SolveReport solve_implicit(const StepResidual& residual, VectorView x, VectorView f);
  /// Freezes ∂f/∂u at x, which the sources hold already.
  void refresh_jacobian(ConstVectorView x, double time);
  /// −δ into update_, from residual_.
  void find_update(const StepResidual& residual);
  /// x ← x + δ. Returns whether another update may help.
  bool full_update(const StepResidual& residual, VectorView x, VectorView f, double& norm, SolveReport& report);
  /// x ← x + s δ with the line search. Returns false where no s lowered the norm.
  bool searched_update(const StepResidual& residual, VectorView x, VectorView f, double& norm, SolveReport& report);

  std::shared_ptr<Model> model_;
  NewtonSettings settings_;
  Halo halo_;
  Halo::State state_;
  std::unique_ptr<StepJacobian> jacobian_;
  VectorView residual_, update_, trial_;

  VectorView frozen_x_;  ///< where ∂f/∂u was taken
  double frozen_time_ = 0.0;
  bool resumed_ = false;
  int age_ = -1;  ///< steps since then; −1: nowhere yet
  int jacobian_evaluations_ = 0;
  long long linear_iterations_ = 0;
};

}  // namespace kiln
