#include "framework/observers/FieldObserver.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>

#include "framework/registry/Registry.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

/// 0, every, 2 every, … and the last step.
std::vector<int> output_steps(int every, int last_step) {
  std::vector<int> steps;
  for (long long step = 0; step < last_step; step += every) steps.push_back(static_cast<int>(step));
  steps.push_back(last_step);
  return steps;
}

std::map<std::string, std::string> attributes_of(const Observer::Context& context) {
  std::map<std::string, std::string> attributes = context.provenance;
  const nlohmann::json facts = provenance(*context.communicator);
  for (const auto& [key, value] : facts.items()) {
    attributes.emplace(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return attributes;
}

}  // namespace

Specification FieldObserver::specification() {
  Specification specification;
  specification.integer("every", "steps between two frames; the first and the last step are always written")
      .at_least(1)
      .defaults_to(100);
  return specification;
}

FieldObserver::FieldObserver(const Teuchos::ParameterList& list, const Context& context)
    : method_(context.method),
      steps_(output_steps(list.get<int>("every"), context.last_step)),
      u_("kiln::observers::state", method_.positions().extent(0) * method_.fields().size()),
      file_(std::make_unique<RunFile>(context.folder, *method_.particles(), method_.positions(),
                                      RunFile::Contents{method_.fields(), steps_, attributes_of(context)},
                                      context.first_step, context.communicator)) {}

void FieldObserver::observe(const Moment& moment) {
  if (!std::binary_search(steps_.begin(), steps_.end(), moment.step)) return;
  method_.state(moment.x, u_);
  file_->write(moment.step, moment.time, u_);
}

void FieldObserver::finish(RunReport& report) {
  report.section("fields") = {{"file", "run.h5"},
                              {"frames", file_->frames_written()},
                              {"particles", method_.particles()->getGlobalNumElements()}};
}

KILN_REGISTER(Observer, FieldObserver, "fields",
              "fields of all particles over time: run.h5, and run.xdmf for ParaView");

}  // namespace kiln
