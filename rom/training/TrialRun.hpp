#pragma once

#include <Teuchos_ParameterList.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/model/ParameterPoints.hpp"
#include "framework/time/StepListener.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/pod/Snapshots.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln {

/// Writes down the state of given particles at every step.
class QueryRecord : public StepListener {
 public:
  /// ids: ascending, all among the method's particles.
  QueryRecord(Method& method, const std::vector<GlobalIndex>& ids);
  void observe(const Moment& moment) override;
  /// One row a step observed, ids × components; the same on every rank. Collective.
  std::vector<double> values() const;

 private:
  Teuchos::RCP<const Communicator> communicator_;
  std::size_t width_;
  std::vector<std::size_t> columns_;  ///< of the row, one a local value
  Method::Reader reader_;
  VectorView read_;
  std::vector<double> values_;
};

/// How far a reduced run is from the full-order run it was trained on.
struct TrialErrors {
  /// Largest |û − u|/|u| of any queried particle at any step (Eq. 35); where the origin of u is free, of its
  /// largest rise.
  double worst_query = 0.0;
  double worst_query_of_rise = 0.0;  ///< largest |û − u| of these, relative to their largest |u − u_0|
  double field = 0.0;                ///< relative L2 error of u − u_0 over all particles and the moments kept
  double iterations_per_step = 0.0;
  long long capped_steps = 0;
  bool diverged = false;

  nlohmann::json facts() const;
  /// Each error the larger of both.
  TrialErrors worse(const TrialErrors& other) const;
};

/// What a trial is measured against.
struct TrialReference {
  ParameterPoints point;  ///< of the live parameters; none: the input's own values
  std::vector<GlobalIndex> queries;
  std::vector<double> query_values;  ///< QueryRecord::values() of the full-order run
  std::vector<int> steps;            ///< at which `states` were taken
  Snapshots states;                  ///< u − u_0 at the full model's rows
};

/// Runs a hyper-reduced method, gnat or ptrom, on a reduction file as a user would and compares it with the full-order
/// run. `full_size`: a reduced method with the same bases on all rows, which tells the whole field. Collective.
TrialErrors trial_run(const std::string& type, const Teuchos::ParameterList& input, const std::filesystem::path& file,
                      const TimeSpan& span, const TrialReference& reference, PetrovGalerkin& full_size,
                      const Teuchos::RCP<const Communicator>& communicator);

}  // namespace kiln
