#include "framework/driver/Study.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cstdio>

#include "framework/base/Error.hpp"
#include "framework/base/ExitStatus.hpp"
#include "framework/base/StopRequest.hpp"
#include "framework/driver/Checkpoint.hpp"
#include "framework/driver/Failure.hpp"
#include "framework/driver/OutputPlace.hpp"
#include "framework/driver/Run.hpp"
#include "framework/driver/StudyCases.hpp"
#include "framework/driver/StudyProgress.hpp"
#include "framework/driver/StudySpecification.hpp"
#include "framework/driver/StudyStates.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Json.hpp"
#include "framework/files/RunFolder.hpp"
#include "framework/files/StandardOutput.hpp"
#include "framework/files/Together.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/report/Timing.hpp"

namespace kiln {
namespace {

using Comm = Teuchos::RCP<const Communicator>;

/// The matrix, its checked inputs and where each case stands.
struct Matrix {
  Input study;
  std::filesystem::path working_folder;
  std::vector<StudyCase> cases;
  StudyInputs inputs;
  std::vector<bool> selected;
  std::vector<CaseState> states;

  Matrix(const StudyOptions& options, const Comm& communicator)
      : study(Input::read(options.file, options.overrides, study_specification(), *communicator)),
        working_folder(broadcast(*communicator, std::filesystem::current_path().string())),
        cases(expand_study(study, working_folder)),
        inputs(study, cases, working_folder, communicator),
        selected(cases.size(), options.only.empty()) {
    for (const std::string& pattern : options.only) select(pattern);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      states.push_back(state_of(i, cases, inputs, states, *communicator));
    }
  }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;

  std::filesystem::path folder() const { return study.list().get<std::string>("output"); }

  int count(CaseStatus status) const {
    int sum = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) sum += selected[i] && states[i].status == status ? 1 : 0;
    return sum;
  }

 private:
  void select(const std::string& pattern) {
    bool found = false;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (fnmatch(pattern.c_str(), cases[i].name.c_str(), 0) != 0) continue;
      found = true;
      for (std::optional<std::size_t> item = i; item; item = cases[*item].needs) selected[*item] = true;
    }
    if (!found) {
      throw InputError("--only " + pattern, "no case has such a name", "a pattern of names that --list shows");
    }
  }
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

class Runner {
 public:
  Runner(Matrix& matrix, bool quiet, const Comm& communicator)
      : matrix_(matrix),
        communicator_(communicator),
        progress_(names(matrix), quiet || communicator->getRank() != 0 ? nullptr : stderr, draws_bars()) {
    for (std::size_t i = 0; i < matrix_.cases.size(); ++i) {
      const CaseState& state = matrix_.states[i];
      waiting_.push_back(matrix_.selected[i] && state.status != CaseStatus::complete);
      const bool timed = state.record && state.record->status == CaseStatus::complete && !state.record->continued;
      if (timed) times_.add(matrix_.inputs.kind(i), state.record->seconds);
    }
  }

  void run_all() {
    write_table();
    for (std::size_t i = 0; i < matrix_.cases.size(); ++i) {
      if (!matrix_.selected[i]) continue;
      CaseState& state = matrix_.states[i];
      state = state_of(i, matrix_.cases, matrix_.inputs, matrix_.states, *communicator_);
      const bool waited = waiting_[i];
      waiting_[i] = false;
      if (state.status == CaseStatus::complete) {
        ++kept_;
        progress_.end(i, std::nullopt, "complete, kept", left());
        continue;
      }
      if (state.identity.is_null()) {
        state.status = CaseStatus::skipped;
        progress_.end(i, std::nullopt, "skipped: " + state.why, left());
      } else {
        waiting_[i] = waited;
        progress_.begin(i, left());
        run_case(i, state);
        waiting_[i] = false;
        const bool complete = state.status == CaseStatus::complete;
        if (complete && !state.record->continued) times_.add(matrix_.inputs.kind(i), state.record->seconds);
        progress_.end(i, state.record->seconds, complete ? "done" : "failed: " + first_line(state.record->message),
                      left());
      }
      write_table();
    }
  }

  int kept() const { return kept_; }

 private:
  static std::vector<std::string> names(const Matrix& matrix) {
    std::vector<std::string> texts;
    for (const StudyCase& item : matrix.cases) texts.push_back(item.name);
    return texts;
  }

  /// Seconds that the cases still to run will take.
  std::optional<double> left() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (!waiting_[i]) continue;
      const std::optional<double> expected = times_.expected(matrix_.inputs.kind(i));
      if (!expected) return std::nullopt;
      sum += *expected;
    }
    return sum;
  }

  void run_case(std::size_t index, CaseState& state) {
    const StudyCase& item = matrix_.cases[index];
    const std::filesystem::path checkpoint = Checkpoint::file(matrix_.inputs.report_folder(index));
    CommandOptions options;
    options.quiet = true;
    options.restart =
        state.status == CaseStatus::running && item.command == "run" && exist({checkpoint}, *communicator_);
    if (!options.restart) remove(checkpoint);

    CaseRecord record;
    record.status = CaseStatus::running;
    record.identity = state.identity;
    record.continued = options.restart;
    write_case_record(item.folder, item.name, record, communicator_);
    reset_peak_memory();
    const Stopwatch watch;
    try {
      const Input& input = matrix_.inputs.of(index);
      item.command == "train" ? train(input, options, communicator_) : run(input, options, communicator_);
      record.status = CaseStatus::complete;
    } catch (const Stopped&) {
      // The case stays interrupted: the next start goes on with it.
      throw;
    } catch (...) {
      record.message = settle_failure(std::current_exception(), *communicator_).message;
      record.status = CaseStatus::failed;
    }
    record.seconds = watch.wall_seconds();
    write_case_record(item.folder, item.name, record, communicator_);
    state.status = record.status;
    state.why.clear();
    state.record = std::move(record);
  }

  /// A checkpoint of another input must never be continued from.
  void remove(const std::filesystem::path& checkpoint) {
    on_root(*communicator_, checkpoint.string(), [&]() -> std::optional<Fault> {
      std::error_code error;
      std::filesystem::remove(checkpoint, error);
      if (error && error != std::errc::not_a_directory) return system_fault("removed", error.value());
      return std::nullopt;
    });
  }

  void write_table() {
    const nlohmann::json table = states_table(matrix_.cases, matrix_.inputs, matrix_.states);
    write_atomically(matrix_.folder() / "study.json", json_text(table, 2) + "\n", communicator_, false);
  }

  Matrix& matrix_;
  Comm communicator_;
  StudyProgress progress_;
  CaseTimes times_;
  std::vector<bool> waiting_;  ///< cases that are still to run
  int kept_ = 0;
};

/// The cases that are not complete, a line each (or more for long messages).
std::string failures_text(const Matrix& matrix) {
  std::size_t width = 0;
  for (const StudyCase& item : matrix.cases) width = std::max(width, item.name.size());
  std::string text;
  for (std::size_t i = 0; i < matrix.cases.size(); ++i) {
    const CaseState& state = matrix.states[i];
    if (!matrix.selected[i] || state.status == CaseStatus::complete) continue;
    const bool failed = state.status == CaseStatus::failed;
    text += fmt::format("{:8} {:{}}  {}\n", to_string(state.status), matrix.cases[i].name, width,
                        failed ? state.record->message : state.why);
  }
  return text;
}

}  // namespace

int study(const StudyOptions& options, const Comm& communicator) {
  const Stopwatch watch;
  Matrix matrix(options, communicator);
  if (!options.allow_outside) {
    std::vector<std::filesystem::path> folders = {matrix.folder()};
    for (std::size_t i = 0; i < matrix.cases.size(); ++i) {
      folders.push_back(matrix.cases[i].folder);
      folders.push_back(matrix.inputs.report_folder(i));
    }
    require_inside(matrix.study, "output", folders, *communicator);
  }
  std::vector<std::size_t> incomplete;
  for (std::size_t i = 0; i < matrix.cases.size(); ++i) {
    if (matrix.selected[i] && matrix.states[i].status != CaseStatus::complete) incomplete.push_back(i);
  }
  matrix.inputs.build(incomplete);

  const RunFolder folder(matrix.folder(), *communicator);
  Runner runner(matrix, options.quiet, communicator);
  runner.run_all();

  const int complete = matrix.count(CaseStatus::complete);
  const int failed = matrix.count(CaseStatus::failed);
  const int skipped = matrix.count(CaseStatus::skipped);
  if (!options.quiet) {
    const auto unselected = std::count(matrix.selected.begin(), matrix.selected.end(), false);
    print(*communicator, fmt::format("{} cases: {} complete ({} of them kept), {} failed, {} skipped{}; {} in all\n",
                                     matrix.cases.size(), complete, runner.kept(), failed, skipped,
                                     unselected == 0 ? "" : fmt::format(", {} not selected", unselected),
                                     short_duration(watch.wall_seconds())));
  }
  if (communicator->getRank() == 0) std::fputs(failures_text(matrix).c_str(), stderr);
  return failed + skipped == 0 ? exit_success : exit_failure;
}

std::string list_study(const StudyOptions& options, const Comm& communicator) {
  const Matrix matrix(options, communicator);
  std::size_t width = 0;
  for (const StudyCase& item : matrix.cases) width = std::max(width, item.name.size());
  std::string text;
  for (std::size_t i = 0; i < matrix.cases.size(); ++i) {
    if (!matrix.selected[i]) continue;
    const CaseState& state = matrix.states[i];
    const bool failed = state.status == CaseStatus::failed;
    const char* const status = state.status == CaseStatus::running ? "interrupted" : to_string(state.status);
    const std::string why = failed ? first_line(state.record->message) : state.why;
    std::string line = fmt::format("{:11}  {:{}}  {}", status, matrix.cases[i].name, width, why);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace kiln
