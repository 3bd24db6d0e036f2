#pragma once

#include <functional>
#include <memory>
#include <string>

#include "framework/driver/TimeLoop.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/model/Model.hpp"
#include "framework/time/NewtonSettings.hpp"
#include "rom/pod/Pod.hpp"

namespace kiln {

/// Training by procedure II of GNAT (Carlberg et al. 2013; §3.3.1 of the report):
///
///   1. full-order run; snapshots u − u0
///   2. their POD: the trial basis Φ
///   3. LSPG without hyper-reduction over the same steps; the residual of every iteration is a snapshot
///   4. their POD: Φ_r, for residual and Jacobian alike; sampling of particles
///   5. A = [PΦ_r]⁺, the sample mesh, and the reduction file
class ProcedureTwo : public Trainer {
 public:
  static Specification specification();
  ProcedureTwo(const Teuchos::ParameterList& block, const Context& context);

  void train(const std::filesystem::path& file, RunReport& report) override;

 private:
  Snapshots run_full_order(RunReport& report);
  Snapshots run_lspg(const Pod& basis, RunReport& report);
  /// Times a stage, shows it on rank 0, and puts its seconds into the report.
  void stage(const std::string& name, RunReport& report, const std::function<void()>& work);
  /// Runs a method from its initial state through the input's time span.
  LoopTotals march(Method& method, std::vector<Observer*> observers, const std::string& label);

  const Teuchos::ParameterList& input_;
  const Teuchos::ParameterList& block_;
  Teuchos::RCP<const Communicator> communicator_;
  bool quiet_;
  TimeSpan span_;
  NewtonSettings newton_;
  PodSettings basis_settings_, residual_settings_;
  std::shared_ptr<Model> model_;
};

}  // namespace kiln
