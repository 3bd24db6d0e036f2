#include "framework/driver/Run.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>

#include "framework/base/Error.hpp"
#include "framework/base/StopRequest.hpp"
#include "framework/driver/Assembly.hpp"
#include "framework/driver/InputHashes.hpp"
#include "framework/driver/OutputPlace.hpp"
#include "framework/driver/QueryRun.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Folders.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/RunFolder.hpp"
#include "framework/files/StandardOutput.hpp"
#include "framework/files/TemporaryFolder.hpp"
#include "framework/files/Together.hpp"
#include "framework/input/Input.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/plugin/Plugins.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/report/ReportText.hpp"
#include "framework/report/RunReport.hpp"
#include "framework/report/Timing.hpp"

namespace kiln {
namespace {

using Comm = Teuchos::RCP<const Communicator>;

/// On what a run was made, from which files, and the libraries whose code took part, if any. Collective.
void report_origins(const nlohmann::json& hashes, RunReport& report, const Communicator& communicator) {
  report.section("provenance") = provenance(communicator);
  report.section("inputs") = hashes;
  for (const plugins::Loaded& plugin : plugins::loaded()) {
    report.section("plugins").push_back({{"name", plugin.file}, {"sha256", plugin.sha256}});
  }
}

struct Seconds {
  double wall;
  double cpu;  ///< summed over ranks
};

Seconds elapsed(const Stopwatch& watch, const Communicator& communicator) {
  return {watch.wall_seconds(), watch.cpu_seconds(communicator)};
}

/// Builds with errors of components placed in the input file.
template <class Build>
auto located(const Input& input, Build&& build) {
  try {
    return build();
  } catch (const InputError& error) {
    throw input.located(error);
  }
}

/// Tells what is to be known before the answers are believed, on the standard error output and in the report.
void warn(const std::vector<std::string>& warnings, RunReport& report, const Communicator& communicator) {
  for (const std::string& warning : warnings) {
    report.section("run")["warnings"].push_back(warning);
    if (communicator.getRank() == 0) fmt::print(stderr, "warning: {}\n", warning);
  }
}

void write_report(const RunReport& report, const std::filesystem::path& folder, const Comm& communicator, bool quiet) {
  const std::string text = readable(report.facts());
  write_atomically(folder / "report.json", json_text(report.facts(), 2) + "\n", communicator);
  write_atomically(folder / "report.txt", text, communicator);
  if (!quiet) print(*communicator, text);
}

/// What an earlier run reported is not true of the files of the one that begins.
void remove_report(const std::filesystem::path& folder, const Communicator& communicator) {
  on_root(communicator, folder.string(), [&folder]() -> std::optional<Fault> {
    for (const char* name : {"report.json", "report.txt"}) std::filesystem::remove(folder / name);
    return std::nullopt;
  });
}

Input read_input(const CommandOptions& options, const Comm& communicator) {
  Input input = Input::read(options.file, options.overrides, run_specification(), *communicator);
  const Teuchos::ParameterList& list = input.list();
  if (!options.allow_outside) {
    require_inside(input, "output.directory",
                   {list.sublist("output").get<std::string>("directory"), run_folder(list), training_folder(list)},
                   *communicator);
  }
  return input;
}

std::unique_ptr<Trainer> make_trainer(const Input& input, bool quiet, const Comm& communicator) {
  const Teuchos::ParameterList& list = input.list();
  if (!list.isSublist("reduction")) {
    throw InputError("", "the input has no block 'reduction'",
                     "a block that says how to train, e.g. reduction: {type: procedure ii, …}");
  }
  return Registry<Trainer>::create(list.sublist("reduction"), {list, communicator, quiet});
}

/// Answers the points of the block `queries`.
void answer_timed(const Stopwatch& total, const Input& input, const CommandOptions& options, const Comm& communicator) {
  const Teuchos::ParameterList& list = input.list();
  if (options.restart) {
    throw InputError("queries", "a run that answers queries leaves no checkpoint", "kiln run without --restart");
  }
  const RunFolder folder(run_folder(list), *communicator);
  const nlohmann::json hashes = input_hashes(input, *communicator);
  const auto queries = located(input, [&] { return std::make_unique<QueryRun>(list, communicator); });
  remove_report(folder.path(), *communicator);
  const Seconds setup = elapsed(total, *communicator);
  const Stopwatch stepping;
  const std::string type = list.sublist("method").get<std::string>("type");
  const QueryAnswers& answers = located(input, [&]() -> const QueryAnswers& { return queries->answer(); });
  const Seconds loop = elapsed(stepping, *communicator);
  write_answers(answers, folder.path(), {{"input", input.merged()}, {"method", type}}, communicator);

  const std::size_t points = answers.points.count(), diverged = queries->diverged();
  RunReport report;
  report.section("run") = {
      {"title", list.get<std::string>("title")},
      {"input", input.file()},
      {"method", type},
      {"status", diverged == 0 ? "complete" : fmt::format("{} of {} points diverged", diverged, points)},
      {"steps", answers.steps.back()},
      {"step_s", list.sublist("time").get<double>("step")}};
  report_origins(hashes, report, *communicator);
  queries->report(report);
  warn(queries->warnings(), report, *communicator);
  const Seconds all = elapsed(total, *communicator);
  report.section("time") = {{"setup_wall_s", setup.wall},
                            {"setup_cpu_s", setup.cpu},
                            {"loop_wall_s", loop.wall},
                            {"loop_cpu_s", loop.cpu},
                            {"total_wall_s", all.wall},
                            {"total_cpu_s", all.cpu},
                            {"loop_wall_a_point_s", loop.wall / static_cast<double>(points)}};
  report.section("time")["peak_memory_bytes"] = peak_memory(*communicator);
  write_report(report, folder.path(), communicator, options.quiet);
  if (diverged == points)
    throw DivergenceError("every point of the queries diverged", list.sublist("time").get<double>("end"));
}

void run_timed(const Stopwatch& total, const Input& input, const CommandOptions& options, const Comm& communicator) {
  if (input.list().isSublist("queries")) return answer_timed(total, input, options, communicator);
  const Timers timers("kiln");
  const Teuchos::ParameterList& list = input.list();
  const RunFolder folder(run_folder(list), *communicator);
  const nlohmann::json hashes = input_hashes(input, *communicator);

  auto assembly = located(input, [&] {
    return std::make_unique<Assembly>(input, data_identity(hashes), folder.path(), communicator, options.restart);
  });
  const std::string type = list.sublist("method").get<std::string>("type");
  if (!options.quiet) {
    assembly->add(std::make_unique<ProgressObserver>(type, assembly->span().first_step, *communicator));
  }
  assembly->begin();
  remove_report(folder.path(), *communicator);
  const Seconds setup = elapsed(total, *communicator);

  RunReport report;
  nlohmann::json& facts = report.section("run");
  facts = {{"title", list.get<std::string>("title")},
           {"input", input.file()},
           {"method", type},
           {"status", "complete"},
           {"steps", assembly->span().last_step},
           {"first_step", assembly->span().first_step},
           {"step_s", assembly->span().step}};
  report_origins(hashes, report, *communicator);

  std::exception_ptr failure;
  const Stopwatch loop;
  LoopTotals totals;
  totals += assembly->solved_before();
  try {
    assembly->march(totals);
  } catch (const DivergenceError& error) {
    facts["status"] = fmt::format("diverged: {}", error.what());
    failure = std::current_exception();
  } catch (const Stopped& stopped) {
    const bool saved = assembly->span().checkpoint_every > 0;
    const std::string message = fmt::format("{}; {}", stopped.what(),
                                            saved ? "checkpoint.h5 holds that step: go on with kiln run --restart"
                                                  : "nothing to go on from: the input has no block output.checkpoint");
    facts["status"] = message;
    failure = std::make_exception_ptr(Stopped(message));
  }
  const Seconds stepping = elapsed(loop, *communicator);
  report.section("solve") = totals.facts();
  warn(totals.warnings(), report, *communicator);
  warn(assembly->method().warnings(), report, *communicator);
  try {
    assembly->finish(report);
  } catch (const std::exception& error) {
    // Why the run ended matters more than what could not be written after it.
    if (failure == nullptr) throw;
    facts["status"] = fmt::format("{}; then {}", facts["status"].get<std::string>(), error.what());
  }
  const Seconds all = elapsed(total, *communicator);
  report.section("time") = {{"setup_wall_s", setup.wall},        {"setup_cpu_s", setup.cpu},
                            {"loop_wall_s", stepping.wall},      {"loop_cpu_s", stepping.cpu},
                            {"steps_wall_s", totals.stepping_s}, {"observers_wall_s", totals.observing_s},
                            {"total_wall_s", all.wall},          {"total_cpu_s", all.cpu}};
  report.section("time")["peak_memory_bytes"] = peak_memory(*communicator);
  report.section("timers")["table"] = timers.table(communicator);
  write_report(report, folder.path(), communicator, options.quiet);
  if (failure != nullptr) std::rethrow_exception(failure);
}

void train_timed(const Stopwatch& total, const Input& input, const CommandOptions& options, const Comm& communicator) {
  const Timers timers("kiln");
  const Teuchos::ParameterList& list = input.list();
  const auto trainer = located(input, [&] {
    auto made = make_trainer(input, options.quiet, communicator);
    made->check();
    return made;
  });
  const RunFolder folder(training_folder(list), *communicator);
  RunReport report;
  report.section("run") = {{"title", list.get<std::string>("title")},
                           {"input", input.file()},
                           {"method", list.sublist("reduction").get<std::string>("type")},
                           {"status", "complete"}};
  report_origins(input_hashes(input, *communicator), report, *communicator);
  remove_report(folder.path(), *communicator);
  located(input, [&] {
    trainer->train(reduction_file(list), report);
    return 0;
  });
  const Seconds all = elapsed(total, *communicator);
  report.section("time") = {{"total_wall_s", all.wall}, {"total_cpu_s", all.cpu}};
  report.section("time")["peak_memory_bytes"] = peak_memory(*communicator);
  report.section("timers")["table"] = timers.table(communicator);
  write_report(report, folder.path(), communicator, options.quiet);
}

}  // namespace

void run(const CommandOptions& options, const Comm& communicator) {
  const Stopwatch total;
  run_timed(total, read_input(options, communicator), options, communicator);
}

void run(const Input& input, const CommandOptions& options, const Comm& communicator) {
  run_timed(Stopwatch(), input, options, communicator);
}

void train(const CommandOptions& options, const Comm& communicator) {
  const Stopwatch total;
  train_timed(total, read_input(options, communicator), options, communicator);
}

void train(const Input& input, const CommandOptions& options, const Comm& communicator) {
  train_timed(Stopwatch(), input, options, communicator);
}

void build(const Input& input, bool trains, const Comm& communicator) {
  const TemporaryFolder folder(*communicator);
  located(input, [&] {
    if (trains) make_trainer(input, true, communicator)->check();
    if (input.list().isSublist("queries")) {
      QueryRun(input.list(), communicator);
    } else {
      Assembly(input, {}, folder.path(), communicator, false);
    }
    return 0;
  });
}

void check(const CommandOptions& options, const Comm& communicator) {
  const Input input = read_input(options, communicator);
  build(input, input.list().isSublist("reduction"), communicator);
  print(*communicator, input.merged());
}

}  // namespace kiln
