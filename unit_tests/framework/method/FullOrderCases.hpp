#pragma once

#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <memory>
#include <string>

#include "framework/method/FullOrder.hpp"
#include "framework/time/TimeScheme.hpp"
#include "unit_tests/framework/model/TestModels.hpp"

namespace kiln {

inline Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

inline std::shared_ptr<LinearSolver> krylov(const std::string& type, double tolerance = 1e-10,
                                            const std::string& preconditioner = "none", int iterations = 300) {
  Teuchos::ParameterList list("time.newton.linear_solver");
  list.set("type", type);
  list.set("tolerance", tolerance);
  list.set("iterations", iterations);
  list.set("preconditioner", preconditioner);
  if (type == "gmres") list.set("restart", 50);
  return Registry<LinearSolver>::create(list, {});
}

inline NewtonSettings newton(JacobianForm jacobian, double tolerance = 1e-12, int iterations = 60, int refresh = 1) {
  NewtonSettings settings;
  settings.jacobian = jacobian;
  settings.tolerance = tolerance;
  settings.iterations = iterations;
  settings.refresh = refresh;
  return settings;
}

inline std::unique_ptr<TimeScheme> scheme(const std::string& type, Method& method, double step) {
  Teuchos::ParameterList list("time.scheme");
  list.set("type", type);
  return Registry<TimeScheme>::create(list, {method, step});
}

inline VectorView initial(const Method& method) {
  const VectorView x("kiln::test::x", local_size(*method.coordinates()));
  method.initial(x);
  return x;
}

/// Advances from step `first` + 1 through step `last`.
inline std::vector<SolveReport> advance(TimeScheme& scheme, VectorView x, double step, int first, int last) {
  std::vector<SolveReport> reports;
  for (int n = first + 1; n <= last; ++n) reports.push_back(scheme.advance(x, n * step));
  return reports;
}

/// One run from the initial state.
inline VectorView run(Method& method, const std::string& type, double step, int steps) {
  const auto time_scheme = scheme(type, method, step);
  const VectorView x = initial(method);
  time_scheme->start(x, 0.0);
  advance(*time_scheme, x, step, 0, steps);
  return x;
}

}  // namespace kiln
