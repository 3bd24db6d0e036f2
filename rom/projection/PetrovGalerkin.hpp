#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/method/Method.hpp"
#include "framework/queries/PointBlock.hpp"
#include "rom/files/Questions.hpp"
#include "rom/files/TrainedRange.hpp"
#include "rom/projection/Projection.hpp"

namespace kiln {

/// A reduced method: a Petrov–Galerkin projection in each of one or more time windows. The unknown x holds the
/// coordinates of all windows; those of windows to come are zero, those of windows past stay as they were, and the
/// window that a step lies in solves for its own. Windows hand over exactly: a trial space begins at the state that the
/// earlier coordinates tell.
class PetrovGalerkin : public Method, public AdvancesTogether {
 public:
  struct Window {
    double end;  ///< s; TimeWindow
    Projection::Parts projection;
    std::shared_ptr<const TrialSpace> held;  ///< on the held particles
  };

  /// What a reduced method is made of.
  struct Parts {
    std::vector<Window> windows;  ///< in the order of time, at least one
    /// The particles whose state the method tells, each on one rank.
    Teuchos::RCP<const Map> particles;
    ConstPositionView positions;
    /// Tells the reduction from one learnt anew (hdf5::File::fingerprint); empty: it comes from no file.
    std::string reduction;
    /// Of the live parameters; empty: it comes from no file.
    std::vector<TrainedRange> trained;
    /// Where `particles` are not all of the model's.
    std::optional<Questions> questions;
  };

  PetrovGalerkin(Parts parts, const NewtonSettings& settings, Projection::Factors factors = Projection::Factors::kept);

  Teuchos::RCP<const Map> coordinates() const override { return coordinates_; }
  LocalIndex row_size() const override { return projection().row_size(); }
  void forget() override;
  /// As Projection::initial of the first window.
  void initial(VectorView x) const override { windows_.front().projection->initial(x); }
  bool begin_step(double time) override;

  void evaluate(ConstVectorView x, double time, VectorView u, VectorView f) override;
  int rate(ConstVectorView x, double time, VectorView dxdt) override { return projection().rate(x, time, dxdt); }
  SolveReport solve(const StepResidual& residual, VectorView x, VectorView u, VectorView f) override;
  /// Asks the model of one window: those of all are the same physics.
  void require_jacobian() override { projection().require_jacobian(); }

  Teuchos::RCP<const Map> particles() const override { return particles_; }
  ConstPositionView positions() const override { return positions_; }
  NearestParticle nearest(const std::array<double, 3>& point) const override;
  std::vector<Field> fields() const override { return projection().model().fields(); }
  void state(ConstVectorView x, VectorView u) const override { windows_[current_].held->state(x, u); }
  Reader reader(const std::vector<LocalIndex>& places) const override;
  /// Those of all windows' models together.
  Parameters& parameters() override { return parameters_; }

  void save(hdf5::Group& group) const override;
  /// Throws FileError for the state of a run on another reduction too: its coordinates are not this one's.
  void restore(const hdf5::Group& group) override;
  std::vector<std::string> warnings() const override;
  void report(nlohmann::json& section) const override;
  void report_work(nlohmann::json& section) const override;

  /// With linear multistep schemes.
  std::unique_ptr<PointBlock> point_block(Request request) override;
  std::size_t window_count() const { return windows_.size(); }
  /// The window that a step which ends at `time` lies in.
  std::size_t window_at(double time) const;
  Projection& projection(std::size_t window) const { return *windows_[window].projection; }
  /// The trial space of a window on particles().
  const TrialSpace& held(std::size_t window) const { return *windows_[window].held; }

  /// Projection::observe_residuals of every window.
  void observe_residuals(const std::function<void(ConstVectorView)>& observer);

 private:
  struct OwnedWindow {
    double end;
    std::unique_ptr<Projection> projection;
    std::shared_ptr<const TrialSpace> held;
  };
  Projection& projection() const { return *windows_[current_].projection; }

  std::vector<OwnedWindow> windows_;
  std::size_t current_ = 0;
  Teuchos::RCP<const Map> particles_;
  ConstPositionView positions_;
  NewtonSettings settings_;
  Teuchos::RCP<const Map> coordinates_;
  Parameters parameters_;
  std::string reduction_;
  std::vector<TrainedRange> trained_;
  std::optional<Questions> questions_;
};

}  // namespace kiln
