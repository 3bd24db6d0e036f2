#include "framework/driver/CommandLine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "framework/base/Error.hpp"
#include "framework/base/ExitStatus.hpp"
#include "framework/base/Nearest.hpp"
#include "framework/base/StopRequest.hpp"
#include "framework/driver/Failure.hpp"
#include "framework/driver/Run.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/driver/Study.hpp"
#include "framework/driver/StudySpecification.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Compare.hpp"
#include "framework/files/StandardOutput.hpp"
#include "framework/files/Together.hpp"
#include "framework/plugin/Plugins.hpp"
#include "framework/registry/Describe.hpp"
#include "framework/registry/Reference.hpp"
#include "framework/registry/Schema.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/report/ReportText.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

void add_outside_flag(CLI::App* command, bool& allow_outside) {
  command->add_flag("--allow-outside", allow_outside,
                    "let the file send results out of the current folder: an absolute folder, '..', links");
}

/// What is loaded before a command looks at any component.
struct PluginOptions {
  std::vector<std::string> files;
  bool none = false;

  void add_to(CLI::App* command) {
    CLI::Option* const plugin =
        command->add_option("--plugin", files, "load a plugin: a shared library that adds components")
            ->type_name("FILE")
            ->allow_extra_args(false);
    command->add_flag("--no-plugins", none, "refuse inputs that name plugins")->excludes(plugin);
  }
  void load(const Communicator& communicator) const {
    if (none) plugins::forbid();
    for (const std::string& file : files) plugins::load(file, "", "--plugin", communicator);
  }
};

void add_input_options(CLI::App* command, CommandOptions& options) {
  command->add_option("FILE", options.file, "input file (YAML)")->required();
  command->add_option("--set", options.overrides, "change one entry of the input, e.g. --set method.type=gnat")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  add_outside_flag(command, options.allow_outside);
}

/// A finite number of at least 0; the library's own check lets NaN pass.
const CLI::Validator non_negative(
    [](const std::string& text) {
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      const bool valid = end != text.c_str() && *end == '\0' && std::isfinite(value) && value >= 0.0;
      return valid ? std::string() : fmt::format("'{}' is not a finite number of at least 0", text);
    },
    "");

/// What is wrong with a command line: the library does not say which word it took for no command.
std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty() || words.front().substr(0, 1) == "-") return error.what();
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) commands.push_back(command->get_name());
  return InputError("", fmt::format("there is no command '{}'", words.front()),
                    fmt::format("one of: {}", fmt::join(commands, ", ")), nearest(words.front(), commands))
      .what();
}

/// A whole file, which `kiln describe` and `kiln template` know by a name of its own.
struct WholeFile {
  const char* name;
  const char* title;
  Specification (*specification)();
};
constexpr WholeFile whole_files[] = {{"input", "input file", run_specification},
                                     {"study", "study file", study_specification}};

/// nullptr: a component is meant.
const WholeFile* whole_file(const std::string& name) {
  for (const WholeFile& file : whole_files) {
    if (name == file.name) return &file;
  }
  return nullptr;
}

/// The pages of `kiln reference`, each written whole.
void write_reference(const std::filesystem::path& folder, const Teuchos::RCP<const Communicator>& communicator) {
  on_root(*communicator, folder.string(), [&folder]() -> std::optional<Fault> {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder)) return Fault{"", "is no folder and cannot be made", "a folder"};
    return std::nullopt;
  });
  std::vector<InputKind> kinds;
  for (const WholeFile& file : whole_files) kinds.push_back({file.name, file.title, file.specification()});
  for (const auto& [name, text] : reference_pages(kinds)) write_atomically(folder / name, text, communicator, false);
}

/// The commands of the program: what their options are read into, and the one that was asked for.
class Commands {
 public:
  Commands(CLI::App& app, const Teuchos::RCP<const Communicator>& communicator)
      : app_(app), communicator_(communicator) {
    app_.require_subcommand(1);
    add_run();
    add_train();
    add_study();
    add_check();
    add_list();
    add_describe();
    add_template();
    add_schema();
    add_reference();
    add_compare();
    add_report();
    for (CLI::App* command : with_plugins_) plugins_.add_to(command);
  }
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// Carries out what the parsed command line asks for; returns its exit status.
  int carry_out() const {
    plugins_.load(*communicator_);
    return command_();
  }

 private:
  CLI::App* add(const char* name, const char* what, std::function<int()> command) {
    CLI::App* added = app_.add_subcommand(name, what);
    added->callback([this, command = std::move(command)] { command_ = command; });
    return added;
  }

  /// One that looks at components, which plugins may add.
  CLI::App* add_with_plugins(const char* name, const char* what, std::function<int()> command) {
    CLI::App* added = add(name, what, std::move(command));
    with_plugins_.push_back(added);
    return added;
  }

  int say(const std::string& text) const {
    print(*communicator_, text);
    return exit_success;
  }

  void add_run() {
    CLI::App* added = add_with_plugins("run", "Run an input: full order or reduced, as its `method` says", [this] {
      const SignalWatch watch;
      run(options_, communicator_);
      return exit_success;
    });
    add_input_options(added, options_);
    added->add_flag("--restart", options_.restart, "continue from the last checkpoint in the run's folder");
    added->add_flag("--quiet", options_.quiet, "no progress bar, no tables");
  }

  void add_train() {
    const char* what = "Learn the reduction that an input's `reduction` block describes";
    CLI::App* added = add_with_plugins("train", what, [this] {
      const SignalWatch watch;
      train(options_, communicator_);
      return exit_success;
    });
    add_input_options(added, options_);
    added->add_flag("--quiet", options_.quiet, "no progress bar, no tables");
  }

  void add_study() {
    const char* what = "Run a matrix of cases; keeps what is complete, resumes the rest";
    CLI::App* added = add_with_plugins("study", what, [this] {
      if (list_only_) return say(list_study(study_options_, communicator_));
      const SignalWatch watch;
      return study(study_options_, communicator_);
    });
    added->add_option("FILE", study_options_.file, "study file (YAML)")->required();
    added
        ->add_option("--set", study_options_.overrides, "change one entry of the study file, e.g. --set output=results")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false);
    added->add_option("--only", study_options_.only, "these cases and what they need, e.g. --only 'part/gnat-*'")
        ->type_name("GLOB")
        ->allow_extra_args(false);
    added->add_flag("--list", list_only_, "print the cases with their states; run nothing");
    add_outside_flag(added, study_options_.allow_outside);
    added->add_flag("--quiet", study_options_.quiet, "no progress; failures are told nonetheless");
  }

  void add_check() {
    const char* what = "Check an input without running it; prints it with all defaults";
    CLI::App* added = add_with_plugins("check", what, [this] {
      check(options_, communicator_);
      return exit_success;
    });
    add_input_options(added, options_);
  }

  void add_list() {
    add_with_plugins("list", "List all components: models, methods, schemes, kernels, …",
                     [this] { return say(list_components()); });
  }

  void add_describe() {
    CLI::App* added = add_with_plugins("describe", "Explain a component and its keys", [this] {
      const WholeFile* file = whole_file(name_);
      return say(file == nullptr ? describe(name_)
                                 : describe(file->specification(), fmt::format("Keys of the {}", file->title)));
    });
    added->add_option("NAME", name_, "a component or a category of `kiln list`; 'input' or 'study' for a whole file")
        ->required();
  }

  void add_template() {
    CLI::App* added = add_with_plugins("template", "Print a commented YAML block to start from", [this] {
      const WholeFile* file = whole_file(name_);
      return say(file == nullptr ? template_of(name_) : template_of(file->specification(), file->title));
    });
    added->add_option("NAME", name_, "a component of `kiln list`; 'input' or 'study' for a whole file")->required();
  }

  void add_schema() {
    CLI::App* added = add_with_plugins("schema", "Print a JSON Schema of input files, for editors", [this] {
      const WholeFile* file = whole_file(kind_);
      if (file == nullptr) {
        throw InputError("", fmt::format("there is no kind of file '{}'", kind_), "input or study",
                         nearest(kind_, {"input", "study"}));
      }
      return say(schema_of(file->specification(), fmt::format("Kiln: {}", file->title)).dump(1) + "\n");
    });
    added->add_option("KIND", kind_, "'input' or 'study'")->capture_default_str();
  }

  void add_reference() {
    const char* what = "Write pages with all keys of all components (Markdown)";
    CLI::App* added = add_with_plugins("reference", what, [this] {
      write_reference(folder_, communicator_);
      return exit_success;
    });
    added->add_option("FOLDER", folder_, "where to")->required();
  }

  void add_compare() {
    const char* what = "Compare two run folders or two result files, field by field";
    CLI::App* added = add("compare", what, [this] { return compare_files(); });
    added->add_option("A", left_, "run folder, .h5, .csv or .json")->required()->check(CLI::ExistingPath);
    added->add_option("B", right_, "the same kind; differences count relative to the larger of two numbers")
        ->required()
        ->check(CLI::ExistingPath);
    added->add_option("--tolerance", compare_settings_.tolerance, "largest relative difference")
        ->capture_default_str()
        ->check(non_negative);
    added->add_option("--floor", compare_settings_.floor, "values below it count as this large")
        ->capture_default_str()
        ->check(non_negative);
    added
        ->add_option("--field", own_tolerances_,
                     "tolerance, and floor in the field's unit, of the fields with this name, as printed; '*' stands "
                     "for any text; of several the first one counts")
        ->type_name("FIELDS=TOLERANCE[,FLOOR]")
        ->allow_extra_args(false);
    added->add_flag("--common", compare_settings_.common,
                    "compare only what both sides hold, and of run files the particles that both hold, by their ids: "
                    "a full-order run with a reduced one");
  }

  int compare_files() const {
    CompareSettings settings = compare_settings_;
    for (const std::string& text : own_tolerances_) settings.own.push_back(field_tolerance(text));
    int status = exit_success;
    std::string text;
    if (communicator_->getRank() == 0) {
      try {
        const CompareResult result = compare(left_, right_, settings);
        text = result.text();
        for (const std::string& problem : result.unreadable) std::fprintf(stderr, "%s\n", problem.c_str());
        status = !result.unreadable.empty() ? exit_bad_input : result.same() ? exit_success : exit_failure;
      } catch (const std::filesystem::filesystem_error& error) {
        std::fprintf(stderr, "%s: %s\n", error.path1().c_str(), error.code().message().c_str());
        status = exit_bad_input;
      }
    }
    print(*communicator_, text);
    Teuchos::broadcast(*communicator_, 0, &status);
    return status;
  }

  void add_report() {
    CLI::App* added = add("report", "Print the report of a finished run",
                          [this] { return say(readable(read_report(folder_, *communicator_))); });
    added->add_option("DIR", folder_, "run folder")->required();
  }

  CLI::App& app_;
  Teuchos::RCP<const Communicator> communicator_;
  PluginOptions plugins_;
  std::vector<CLI::App*> with_plugins_;
  CommandOptions options_;
  StudyOptions study_options_;
  bool list_only_ = false;
  std::string name_, kind_ = "input", left_, right_, folder_;
  CompareSettings compare_settings_;
  std::vector<std::string> own_tolerances_;
  std::function<int()> command_;
};

}  // namespace

int command_line(int argc, char** argv, const Teuchos::RCP<const Communicator>& communicator) {
  CLI::App app("Kiln: heat deposition by smoothed particle hydrodynamics, full order or reduced, from one YAML file.",
               "kiln");
  app.set_version_flag("--version", version_line());
  app.footer(
      "Exit status: 0 done, 1 a comparison differs, a case of a study failed or an unforeseen error, 2 bad input or "
      "data file, 3 the solve diverged, 4 stopped by SIGTERM or SIGINT.\nRun the computing commands on R ranks with "
      "mpirun -n R kiln …");
  Commands commands(app, communicator);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool is_mistake = error.get_exit_code() != 0;
    if (communicator->getRank() == 0) {
      if (is_mistake) {
        std::fprintf(stderr, "%s\nRun with --help for more information.\n", message_of(app, error).c_str());
      } else {
        app.exit(error);
      }
    }
    return is_mistake ? exit_bad_input : exit_success;
  }

  try {
    return commands.carry_out();
  } catch (...) {
    return report_failure(std::current_exception(), *communicator);
  }
}

}  // namespace kiln
