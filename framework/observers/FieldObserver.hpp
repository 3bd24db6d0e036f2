#pragma once

#include <memory>
#include <vector>

#include "framework/files/RunFile.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/registry/Specification.hpp"

namespace kiln {

/// Writes the state of all particles that the method can tell into run.h5, every so many steps and at the last one.
class FieldObserver : public Observer {
 public:
  static Specification specification();
  FieldObserver(const Teuchos::ParameterList& list, const Context& context);

  void begin() override;
  void observe(const Moment& moment) override;
  void finish(RunReport& report) override;

 private:
  Context context_;
  std::vector<int> steps_;
  VectorView u_;
  std::unique_ptr<RunFile> file_;  ///< null before begin()
};

}  // namespace kiln
