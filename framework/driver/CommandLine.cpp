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
#include "framework/driver/ExitStatus.hpp"
#include "framework/driver/Failure.hpp"
#include "framework/driver/Run.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/driver/StopRequest.hpp"
#include "framework/driver/Study.hpp"
#include "framework/driver/StudySpecification.hpp"
#include "framework/files/AtomicFile.hpp"
#include "framework/files/Compare.hpp"
#include "framework/files/Together.hpp"
#include "framework/plugin/Plugins.hpp"
#include "framework/registry/Describe.hpp"
#include "framework/registry/Nearest.hpp"
#include "framework/registry/Reference.hpp"
#include "framework/registry/Schema.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/report/ReportText.hpp"
#include "framework/report/RunReport.hpp"

namespace kiln {
namespace {

void print(const Communicator& communicator, const std::string& text) {
  if (communicator.getRank() == 0) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }
}

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

}  // namespace

int command_line(int argc, char** argv, const Teuchos::RCP<const Communicator>& communicator) {
  CLI::App app("Kiln: heat deposition by smoothed particle hydrodynamics, full order or reduced, from one YAML file.",
               "kiln");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_line());
  app.footer(
      "Exit status: 0 done, 1 a comparison differs, a case of a study failed or an unforeseen error, 2 bad input or "
      "data file, 3 the solve "
      "diverged, 4 stopped by SIGTERM or SIGINT.\nRun the computing commands on R ranks with mpirun -n R kiln …");

  CommandOptions options;
  std::string name, left, right, folder;
  double tolerance = 1e-10;
  double floor = 0.0;
  std::vector<std::string> own_tolerances;
  std::function<int()> command;
  PluginOptions plugin_options;

  CLI::App* run_app = app.add_subcommand("run", "Run an input: full order or reduced, as its `method` says");
  add_input_options(run_app, options);
  run_app->add_flag("--restart", options.restart, "continue from the last checkpoint in the run's folder");
  run_app->add_flag("--quiet", options.quiet, "no progress bar, no tables");
  run_app->callback([&] {
    command = [&]() -> int {
      const SignalWatch watch;
      run(options, communicator);
      return exit_success;
    };
  });

  CLI::App* train_app = app.add_subcommand("train", "Learn the reduction that an input's `reduction` block describes");
  add_input_options(train_app, options);
  train_app->add_flag("--quiet", options.quiet, "no progress bar, no tables");
  train_app->callback([&] {
    command = [&]() -> int {
      const SignalWatch watch;
      train(options, communicator);
      return exit_success;
    };
  });

  StudyOptions study_options;
  bool list_only = false;
  CLI::App* study_app = app.add_subcommand("study", "Run a matrix of cases; keeps what is complete, resumes the rest");
  study_app->add_option("FILE", study_options.file, "study file (YAML)")->required();
  study_app
      ->add_option("--set", study_options.overrides, "change one entry of the study file, e.g. --set output=results")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  study_app->add_option("--only", study_options.only, "these cases and what they need, e.g. --only 'part/gnat-*'")
      ->type_name("GLOB")
      ->allow_extra_args(false);
  study_app->add_flag("--list", list_only, "print the cases with their states; run nothing");
  add_outside_flag(study_app, study_options.allow_outside);
  study_app->add_flag("--quiet", study_options.quiet, "no progress; failures are told nonetheless");
  study_app->callback([&] {
    command = [&]() -> int {
      if (list_only) {
        print(*communicator, list_study(study_options, communicator));
        return exit_success;
      }
      const SignalWatch watch;
      return study(study_options, communicator);
    };
  });

  CLI::App* check_app = app.add_subcommand("check", "Check an input without running it; prints it with all defaults");
  add_input_options(check_app, options);
  check_app->callback([&] {
    command = [&]() -> int {
      check(options, communicator);
      return exit_success;
    };
  });

  CLI::App* list_app = app.add_subcommand("list", "List all components: models, methods, schemes, kernels, …");
  list_app->callback([&] {
    command = [&]() -> int {
      print(*communicator, list_components());
      return exit_success;
    };
  });

  CLI::App* describe_app = app.add_subcommand("describe", "Explain a component and its keys");
  describe_app
      ->add_option("NAME", name, "a component or a category of `kiln list`; 'input' or 'study' for a whole file")
      ->required();
  describe_app->callback([&] {
    command = [&]() -> int {
      const WholeFile* file = whole_file(name);
      print(*communicator, file == nullptr
                               ? describe(name)
                               : describe(file->specification(), fmt::format("Keys of the {}", file->title)));
      return exit_success;
    };
  });

  CLI::App* template_app = app.add_subcommand("template", "Print a commented YAML block to start from");
  template_app->add_option("NAME", name, "a component of `kiln list`; 'input' or 'study' for a whole file")->required();
  template_app->callback([&] {
    command = [&]() -> int {
      const WholeFile* file = whole_file(name);
      print(*communicator, file == nullptr ? template_of(name) : template_of(file->specification(), file->title));
      return exit_success;
    };
  });

  std::string kind = "input";
  CLI::App* schema_app = app.add_subcommand("schema", "Print a JSON Schema of input files, for editors");
  schema_app->add_option("KIND", kind, "'input' or 'study'")->capture_default_str();
  schema_app->callback([&] {
    command = [&]() -> int {
      const WholeFile* file = whole_file(kind);
      if (file == nullptr) {
        throw InputError("", fmt::format("there is no kind of file '{}'", kind), "input or study",
                         nearest(kind, {"input", "study"}));
      }
      print(*communicator, schema_of(file->specification(), fmt::format("Kiln: {}", file->title)).dump(1) + "\n");
      return exit_success;
    };
  });

  CLI::App* reference_app = app.add_subcommand("reference", "Write pages with all keys of all components (Markdown)");
  reference_app->add_option("FOLDER", folder, "where to")->required();
  reference_app->callback([&] {
    command = [&]() -> int {
      write_reference(folder, communicator);
      return exit_success;
    };
  });

  for (CLI::App* loads :
       {run_app, train_app, study_app, check_app, list_app, describe_app, template_app, schema_app, reference_app}) {
    plugin_options.add_to(loads);
  }

  CLI::App* compare_app = app.add_subcommand("compare", "Compare two run folders or two result files, field by field");
  compare_app->add_option("A", left, "run folder, .h5, .csv or .json")->required()->check(CLI::ExistingPath);
  compare_app->add_option("B", right, "the same kind; A's errors are relative to it")
      ->required()
      ->check(CLI::ExistingPath);
  compare_app->add_option("--tolerance", tolerance, "largest relative difference")
      ->capture_default_str()
      ->check(non_negative);
  compare_app->add_option("--floor", floor, "values below it count as this large")
      ->capture_default_str()
      ->check(non_negative);
  compare_app
      ->add_option("--field", own_tolerances,
                   "tolerance, and floor in the field's unit, of the fields with this name, as printed; '*' stands for "
                   "any text; of several the first one counts")
      ->type_name("FIELDS=TOLERANCE[,FLOOR]")
      ->allow_extra_args(false);
  compare_app->callback([&] {
    command = [&]() -> int {
      std::vector<FieldTolerance> own;
      for (const std::string& text : own_tolerances) own.push_back(field_tolerance(text));
      int status = exit_success;
      if (communicator->getRank() == 0) {
        const CompareResult result = compare(left, right, tolerance, floor, own);
        print(*communicator, result.text());
        for (const std::string& problem : result.unreadable) std::fprintf(stderr, "%s\n", problem.c_str());
        status = !result.unreadable.empty() ? exit_bad_input : result.same() ? exit_success : exit_failure;
      }
      Teuchos::broadcast(*communicator, 0, &status);
      return status;
    };
  });

  CLI::App* report_app = app.add_subcommand("report", "Print the report of a finished run");
  report_app->add_option("DIR", folder, "run folder")->required();
  report_app->callback([&] {
    command = [&]() -> int {
      print(*communicator, readable(read_report(folder, *communicator)));
      return exit_success;
    };
  });

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
    plugin_options.load(*communicator);
    return command();
  } catch (...) {
    return report_failure(std::current_exception(), *communicator);
  }
}

}  // namespace kiln
