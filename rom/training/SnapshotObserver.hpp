#pragma once

#include "framework/observers/Observer.hpp"
#include "rom/pod/Snapshots.hpp"

namespace kiln {

/// Collects u − u0 of every `every`-th step and of the last one into snapshots over the method's particles.
class SnapshotObserver : public Observer {
 public:
  /// Both must outlive the observer. Takes u0 from the method.
  SnapshotObserver(Method& method, Snapshots& snapshots, int every);

  void begin() override {}
  void observe(const Moment& moment) override;
  void finish(RunReport& report) override;

 private:
  Method& method_;
  Snapshots& snapshots_;
  int every_;
  VectorView reference_, state_;
};

}  // namespace kiln
