#include "framework/observers/FieldObserver.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <algorithm>

#include "framework/base/Error.hpp"
#include "framework/files/Json.hpp"
#include "framework/model/DegreesOfFreedom.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

/// Each frame is a dataset that HDF5 keeps account of.
constexpr int most_frames = 100000;

/// 0, every, 2 every, … and the last step.
std::vector<int> output_steps(const Teuchos::ParameterList& list, int last_step) {
  const int every = list.get<int>("every");
  if (last_step / every > most_frames) {
    throw InputError(list.name() + ".every", fmt::format("gives {} frames", last_step / every),
                     fmt::format("at most {}", most_frames));
  }
  std::vector<int> steps;
  for (long long step = 0; step < last_step; step += every) steps.push_back(static_cast<int>(step));
  steps.push_back(last_step);
  return steps;
}

std::map<std::string, std::string> attributes_of(const Observer::Context& context) {
  std::map<std::string, std::string> attributes = context.provenance;
  const nlohmann::json facts = provenance(*context.communicator);
  for (const auto& [key, value] : facts.items()) {
    attributes.emplace(key, value.is_string() ? value.get<std::string>() : json_text(value));
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
    : context_(context),
      steps_(output_steps(list, context.last_step)),
      u_("kiln::observers::state", context.method.positions().extent(0) * context.method.fields().size()) {}

void FieldObserver::begin() {
  const Method& method = context_.method;
  const auto states = degree_of_freedom_map(method.particles(), static_cast<int>(method.fields().size()));
  RunFile::Contents contents{method.fields(), steps_, attributes_of(context_)};
  // Where the unknown is not the state itself, it is what the whole field can be computed from.
  if (!method.coordinates()->isSameAs(*states)) contents.coordinates = method.coordinates()->getGlobalNumElements();
  file_ = std::make_unique<RunFile>(context_.folder, *method.particles(), method.positions(), std::move(contents),
                                    context_.first_step, context_.communicator);
}

void FieldObserver::observe(const Moment& moment) {
  if (std::binary_search(steps_.begin(), steps_.end(), moment.step)) {
    context_.method.state(moment.x, u_);
    file_->write(moment.step, moment.time, u_, moment.x);
  }
}

void FieldObserver::finish(RunReport& report) {
  file_->write_xdmf();
  report.section("fields") = {{"file", "run.h5"},
                              {"frames", file_->frames_written()},
                              {"particles", context_.method.particles()->getGlobalNumElements()}};
}

KILN_REGISTER(Observer, FieldObserver, "fields",
              "fields of all particles over time: run.h5, and run.xdmf for ParaView");

}  // namespace kiln
