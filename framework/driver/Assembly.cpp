#include "framework/driver/Assembly.hpp"

#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <nlohmann/json.hpp>

#include "framework/driver/Checkpoint.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

/// What a restart must have in common with the run it goes on with: all that decides its numbers, and which of them its
/// tables hold, row after row. `data`: data_identity of the input.
std::string identity_of(const Teuchos::ParameterList& list, const std::string& data) {
  Teuchos::ParameterList tables(list.sublist("output"));
  for (const char* key : {"directory", "checkpoint"}) tables.remove(key, false);
  return fmt::format("model:\n{}time:\n{}method:\n{}output:\n{}data files:\n{}", to_yaml(list.sublist("model")),
                     to_yaml(list.sublist("time")), to_yaml(list.sublist("method")), to_yaml(tables), data);
}

}  // namespace

Assembly::Assembly(const Input& input, const std::string& data, const std::filesystem::path& folder,
                   const Teuchos::RCP<const Communicator>& communicator, bool restart)
    : span_(TimeSpan::of(input.list())) {
  const Teuchos::ParameterList& list = input.list();
  method_ = Registry<Method>::create(list.sublist("method"), {list, communicator});
  scheme_ = Registry<TimeScheme>::create(list.sublist("time").sublist("scheme"), {*method_, span_.step});
  x_ = VectorView("kiln::run::unknown", local_size(*method_->coordinates()));
  const std::string identity = identity_of(list, data);
  if (restart) {
    const auto [step, solved] =
        Checkpoint::restore(folder, identity, *method_, *scheme_, x_, span_.last_step, communicator);
    span_.first_step = step;
    solved_before_ = solved;
  } else {
    method_->initial(x_);
    scheme_->start(x_, 0.0);
  }
  const Observer::Context context{
      *method_,
      folder,
      communicator,
      span_.first_step,
      span_.last_step,
      span_.step,
      {{"input", input.merged()}, {"method", list.sublist("method").get<std::string>("type")}}};
  const Teuchos::ParameterList& output = list.sublist("output");
  for (auto entry = output.begin(); entry != output.end(); ++entry) {
    const std::string& key = output.name(entry);
    if (!output.isSublist(key) || key == "checkpoint") continue;
    observers_.push_back(Registry<Observer>::create(output.sublist(key), context));
  }
  if (output.isSublist("checkpoint")) {
    observers_.push_back(std::make_unique<Checkpoint>(context, *scheme_, identity, solved_before_));
  }
}

void Assembly::begin() {
  for (const auto& observer : observers_) observer->begin();
}

void Assembly::march(LoopTotals& totals) {
  std::vector<StepListener*> listeners;
  for (const auto& observer : observers_) listeners.push_back(observer.get());
  run_time_loop(*method_, *scheme_, x_, span_, listeners, totals);
}

void Assembly::finish(RunReport& report) {
  for (const auto& observer : observers_) observer->finish(report);
  method_->report(report.section("method"));
  method_->report_work(report.section("method"));
}

}  // namespace kiln
