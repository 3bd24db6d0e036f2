#include "framework/solvers/NewtonSettings.hpp"

#include <array>
#include <utility>

#include "framework/base/Error.hpp"
#include "framework/base/Nearest.hpp"
#include "framework/solvers/LinearSolver.hpp"

namespace kiln {
namespace {

constexpr std::array<std::pair<JacobianForm, const char*>, 4> forms{
    {{JacobianForm::diagonal, "diagonal"},
     {JacobianForm::sparse, "sparse"},
     {JacobianForm::matrix_free, "matrix free"},
     {JacobianForm::finite_difference, "finite difference"}}};

std::vector<std::string> form_names() {
  std::vector<std::string> names;
  for (const auto& [form, name] : forms) names.push_back(name);
  return names;
}

JacobianForm jacobian_form(const Teuchos::ParameterList& list) {
  const std::string text = list.get<std::string>("jacobian");
  for (const auto& [form, name] : forms) {
    if (text == name) return form;
  }
  throw InputError(list.name() + ".jacobian", "there is no Jacobian form '" + text + "'",
                   "diagonal, sparse, matrix free or finite difference", nearest(text, form_names()));
}

}  // namespace

std::string to_text(JacobianForm form) {
  for (const auto& [known, name] : forms) {
    if (known == form) return name;
  }
  throw std::logic_error("a JacobianForm without a name");
}

NewtonSettings::NewtonSettings(const Teuchos::ParameterList& list)
    : tolerance(list.get<double>("tolerance")),
      iterations(list.get<int>("iterations")),
      jacobian(jacobian_form(list)),
      refresh(list.get<int>("refresh")),
      line_search(list.get<bool>("line_search")) {}

Specification NewtonSettings::specification() {
  const NewtonSettings defaults;
  Specification s;
  s.real("tolerance", "residual norm at which a step is solved, relative to the step's first one")
      .above(0)
      .below(1)
      .defaults_to(defaults.tolerance);
  s.integer("iterations", "cap on updates a step").at_least(1).defaults_to(defaults.iterations);
  s.choice("jacobian", "approximation of the rate's Jacobian", form_names()).defaults_to(to_text(defaults.jacobian));
  s.integer("refresh", "steps between two evaluations of the Jacobian").at_least(1).defaults_to(defaults.refresh);
  s.flag("line_search", "halve an update until the residual norm falls").defaults_to(defaults.line_search);
  s.component<LinearSolver>("linear_solver", "solver of the linear systems; the diagonal Jacobian needs none")
      .defaults_to("gmres");
  return s;
}

}  // namespace kiln
