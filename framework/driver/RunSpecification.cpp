#include "framework/driver/RunSpecification.hpp"

#include "framework/method/Method.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/observers/Observer.hpp"
#include "framework/queries/QueryPoints.hpp"
#include "framework/solvers/NewtonSettings.hpp"
#include "framework/time/TimeScheme.hpp"

namespace kiln {
namespace {

Specification time_specification() {
  Specification specification;
  specification.real("end", "time the run ends at; a multiple of the step").unit("s").above(0);
  specification.real("step", "time step, the same throughout").unit("s").above(0);
  specification.component<TimeScheme>("scheme", "how a step is taken").defaults_to("backward euler");
  specification.section("newton", "how an implicit step's system is solved", NewtonSettings::specification());
  return specification;
}

Specification checkpoint_specification() {
  Specification specification;
  specification.integer("every", "steps between two checkpoints").at_least(1).defaults_to(500);
  specification.real("pause", "least wall time between two checkpoints: a run shorter than that needs none")
      .unit("s")
      .at_least(0)
      .defaults_to(0.0);
  return specification;
}

Specification output_specification() {
  Specification specification;
  specification
      .text("directory",
            "folder of all results, relative to where kiln is started; a run writes into its subfolder named by the "
            "method, training into 'training'")
      .defaults_to("results");
  specification.section("checkpoint", "states to restart from; left out: none", checkpoint_specification()).optional();
  specification.blocks<Observer>("what is written during the run");
  return specification;
}

}  // namespace

Specification run_specification() {
  Specification specification;
  specification.text("title", "one line that names the case in reports and pictures").defaults_to("");
  specification
      .texts("plugins",
             "shared libraries that add components; looked for beside this file, in KILN_PLUGIN_PATH and in "
             "lib/kiln/plugins "
             "of the installation")
      .optional();
  specification.component<Model>("model", "the full-order model: du/dt = f(u, t; µ)");
  specification.section("time", "time span, scheme and solver", time_specification());
  specification.component<Method>("method", "full order, or which reduction of it").defaults_to("fom");
  specification.component<Trainer>("reduction", "how `kiln train` learns the reduction").optional();
  specification
      .section("queries",
               "points of the model's live parameters, all answered in one run: histories of the probes for each",
               query_specification())
      .optional();
  specification.section("output", "what is written and where", output_specification());
  return specification;
}

}  // namespace kiln
