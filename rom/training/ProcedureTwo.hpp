#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "framework/method/Trainer.hpp"
#include "framework/model/Model.hpp"
#include "framework/solvers/NewtonSettings.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/files/Reduction.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/training/FullOrderRuns.hpp"
#include "rom/training/TimeWindows.hpp"

namespace kiln {

/// Training by procedure II of GNAT (Carlberg et al. 2013; §3.3.1 of the report), in each of one or more time windows:
///
///   1. full-order runs, one or at each point of `train_on`; snapshots u − u0
///   2. the windows, and in each the POD of u_n − u_begin: its trial basis Φ
///   3. LSPG without hyper-reduction over the same steps, at each of these points; the residual of every iteration is a
///      snapshot. Window by window, while it stands there: the residuals' POD Φ_r, for residual and Jacobian alike;
///      sampling of particles; A = [PΦ_r]⁺ and the sample mesh; where asked for, clusters of its sources
///   4. the reduction file
///   5. a trial run of what is in the file at each of these points and those of `try_on`; its errors against the
///      full-order runs go into report and file
///
/// Where windows are asked for that hold an error, 2 to 5 are repeated with shorter windows until the trial run says
/// so.
class ProcedureTwo : public Trainer {
 public:
  static Specification specification();
  ProcedureTwo(const Teuchos::ParameterList& block, const Context& context);

  void check() override { full_order_ = full_order_runs(); }
  void train(const std::filesystem::path& file, RunReport& report) override;

 private:
  /// Those of stage 1, before they run. Throws InputError for what the model rules out.
  std::unique_ptr<FullOrderRuns> full_order_runs() const;
  /// Throws InputError for a rank of the basis above what so many snapshots, of which `hold` are held, can give.
  void check_ranks(std::size_t snapshots, std::optional<int> hold) const;
  void run_full_order(RunReport& report);
  /// How many states of a run are kept, the initial one apart.
  int snapshots() const;
  /// Steps at which windows end, for windows that hold `error` where the input asks for that.
  std::vector<int> window_ends(double error) const;
  std::vector<Pod> window_bases(const std::vector<int>& ends, RunReport& report) const;
  /// Bases of the windows on all rows.
  std::unique_ptr<PetrovGalerkin> lspg_method(const std::vector<int>& ends, const std::vector<Pod>& bases) const;
  /// What trial runs of one reduction found.
  struct Trials {
    TrialErrors gnat;
    std::optional<TrialErrors> ptrom;  ///< on the clustered sample mesh, where there is one
  };
  /// One reduction, tried: the file is at `path` when it returns.
  Trials attempt(const std::string& path, double error, RunReport& report);
  /// The worst over all points of a hyper-reduced method; each point's own errors go into the report, as `section`.
  TrialErrors try_all(const std::string& method, const std::string& section, const std::string& path,
                      PetrovGalerkin& lspg, RunReport& report) const;
  /// Times a stage, shows it on rank 0, and puts its seconds into the report.
  void stage(const std::string& name, RunReport& report, const std::function<void()>& work);
  void warn(const std::string& warning, RunReport& report) const;
  void warn_of(const TrialErrors& errors, const std::string& run, RunReport& report) const;
  bool clusters() const { return block_.isSublist("clustering"); }

  const Teuchos::ParameterList& input_;
  const Teuchos::ParameterList& block_;
  Teuchos::RCP<const Communicator> communicator_;
  bool quiet_;
  TimeSpan span_;
  NewtonSettings newton_;
  PodSettings basis_settings_, residual_settings_;
  WindowSettings windows_;
  int every_;                                  ///< steps between two snapshots
  std::unique_ptr<FullOrderRuns> full_order_;  ///< made by check()
  std::unique_ptr<WindowCosts> costs_;         ///< where windows hold an error
};

}  // namespace kiln
