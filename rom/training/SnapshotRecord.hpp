#pragma once

#include "framework/method/Method.hpp"
#include "framework/time/StepListener.hpp"
#include "rom/pod/Snapshots.hpp"

namespace kiln {

/// Collects u − u0 of every `every`-th step and of the last one into snapshots over the method's particles.
class SnapshotRecord : public StepListener {
 public:
  /// Both must outlive the record. Takes u0 from the method.
  SnapshotRecord(Method& method, Snapshots& snapshots, int every);

  void observe(const Moment& moment) override;

 private:
  Method& method_;
  Snapshots& snapshots_;
  int every_;
  VectorView reference_, state_;
};

/// Collects u − u0 of given steps, ascending, which must outlive the record.
class StateRecord : public StepListener {
 public:
  StateRecord(Method& method, const std::vector<int>& steps, Snapshots& states);

  void observe(const Moment& moment) override;

 private:
  const std::vector<int>& steps_;
  SnapshotRecord every_;
};

}  // namespace kiln
