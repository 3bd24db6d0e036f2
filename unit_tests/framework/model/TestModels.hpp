#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/model/Model.hpp"
#include "framework/registry/Registry.hpp"

/// Small models that tests of the framework solve. Registered in the test programs that link TestModels.cpp.
namespace kiln {

/// u' = −2 s t u² with u(0) = 1 and the solution 1/(1 + s t²), s = `strength`: nonlinear and time-dependent, so that a
/// scheme's times count. One particle on rank 0; other ranks are empty.
class RationalDecay : public Model {
 public:
  static Specification specification();
  RationalDecay(const Teuchos::ParameterList& list, const Context& context);
  explicit RationalDecay(const Teuchos::RCP<const Communicator>& communicator);
  double solution(double time) const;

  Teuchos::RCP<const Map> rows() const override { return map_; }
  Teuchos::RCP<const Map> sources() const override { return map_; }
  std::vector<Field> fields() const override { return {{"concentration", "mol"}}; }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;

 private:
  Teuchos::RCP<const Map> map_;
  double strength_ = 1.0;
};

/// A line of particles, u_i' = k (u_{i−1} − 2 u_i + u_{i+1}) − r u_i³ + q_i (1 + sin 3t), insulated at its ends: rows
/// in blocks over the ranks, neighbours of other ranks as sources, a symmetric Jacobian in all forms. It samples
/// itself.
class DiffusionChain : public Model {
 public:
  struct Settings {
    int particles = 23;
    double conduction = 5.0;
    double reaction = 0.4;
  };
  static Specification specification();
  DiffusionChain(const Teuchos::ParameterList& list, const Context& context);
  DiffusionChain(const Settings& settings, const Teuchos::RCP<const Communicator>& communicator);

  Teuchos::RCP<const Map> rows() const override { return rows_; }
  Teuchos::RCP<const Map> sources() const override { return sources_; }
  std::vector<Field> fields() const override { return {{"temperature", "K"}}; }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;
  ConstPositionView positions() const override { return positions_; }
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const override;
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const override;
  Teuchos::RCP<const CrsMatrix> rate_jacobian_matrix(ConstVectorView u, double time) const override;
  std::unique_ptr<Model> sampled(const std::vector<GlobalIndex>& rows) const override;

 private:
  DiffusionChain(const DiffusionChain& full, const std::vector<GlobalIndex>& rows);
  void set_rows(const std::vector<GlobalIndex>& rows);

  Settings settings_;
  Teuchos::RCP<const Map> rows_, sources_, domain_;
  PositionView positions_;
  /// Sources left and right of each row; a row's own index where the line ends.
  std::vector<LocalIndex> left_, right_;
  mutable Teuchos::RCP<CrsMatrix> matrix_;
};

/// A ring of pendulums, θ' = ω, ω' = −g sin θ + c (θ_{i−1} − 2 θ_i + θ_{i+1}): two components a particle and nothing
/// but `rate`.
class PendulumRing : public Model {
 public:
  static Specification specification();
  PendulumRing(const Teuchos::ParameterList& list, const Context& context);
  PendulumRing(int particles, const Teuchos::RCP<const Communicator>& communicator);

  Teuchos::RCP<const Map> rows() const override { return rows_; }
  Teuchos::RCP<const Map> sources() const override { return sources_; }
  std::vector<Field> fields() const override { return {{"angle", "rad"}, {"angular velocity", "rad/s"}}; }
  void initial_state(VectorView u) const override;
  void rate(ConstVectorView u, double time, VectorView f) const override;

 private:
  GlobalIndex particles_;
  double gravity_ = 4.0, coupling_ = 2.0;
  Teuchos::RCP<const Map> rows_, sources_;
  std::vector<LocalIndex> left_, right_;
};

}  // namespace kiln
