#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "framework/base/NearestParticle.hpp"
#include "framework/files/CsvTable.hpp"
#include "framework/observers/Extremes.hpp"
#include "framework/observers/FieldObserver.hpp"
#include "framework/observers/ProbeObserver.hpp"
#include "framework/observers/ProgressObserver.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/RunReport.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/framework/observers/StandInMethod.hpp"

namespace kiln {
namespace {

using Point = std::array<double, 3>;

constexpr int last_step = 7;
constexpr double step_length = 0.1;

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

Observer::Context context_of(StandInMethod& method, const TestFolder& folder, int first_step = 0) {
  return {method, folder.path(), world(), first_step, last_step, step_length, {{"input", "a: 1"}, {"method", "fom"}}};
}

Teuchos::ParameterList probe_list(const std::vector<std::pair<std::string, Point>>& probes, int every = 1) {
  Teuchos::ParameterList list("output.probes");
  list.set("every", every);
  Teuchos::ParameterList& points = list.sublist("points");
  for (std::size_t i = 0; i < probes.size(); ++i) {
    Teuchos::ParameterList& entry = points.sublist(std::to_string(i));
    entry.set("name", probes[i].first);
    entry.set("position", Teuchos::Array<double>(probes[i].second.begin(), probes[i].second.end()));
  }
  return list;
}

/// `checkpoint`: a step after which one is written.
void run(Observer& observer, const StandInMethod& method, int first_step, int end_step, int checkpoint = -1) {
  observer.begin();
  for (int step = first_step == 0 ? 0 : first_step + 1; step <= end_step; ++step) {
    observer.observe({step, last_step, step * step_length, method.unknown(step), {}, step == checkpoint});
  }
}

std::string contents_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(NearestParticle, IsTheSameOnEveryRank) {
  const StandInMethod method;
  const auto nearest = nearest_particle(*method.particles(), method.positions(), {2.1e-5, 0.9e-5, 1.3e-5});
  EXPECT_EQ(nearest.id, 12 + 4 + 2);
  EXPECT_EQ(nearest.rank, nearest.id % world()->getSize());
  EXPECT_EQ(nearest.position, (Point{2e-5, 1e-5, 1e-5}));
  EXPECT_NEAR(nearest.distance, std::sqrt(1.0 + 1.0 + 9.0) * 1e-6, 1e-18);
  EXPECT_NEAR(nearest.spacing, 1e-5, 1e-18);
}

TEST(NearestParticle, OfEquallyNearOnesTheLowestIdCounts) {
  const StandInMethod method;
  EXPECT_EQ(nearest_particle(*method.particles(), method.positions(), {-1e-5, 0.5e-5, 0.5e-5}).id, 0);
}

TEST(ProbeObserver, WritesTheNearestParticlesHistory) {
  TestFolder folder;
  StandInMethod method;
  ProbeObserver observer(probe_list({{"one", {1.2e-5, 0, 0}}, {"a \"b\", c", {3e-5, 2e-5, 1e-5}}}),
                         context_of(method, folder));
  run(observer, method, 0, last_step);
  RunReport report;
  observer.finish(report);
  world()->barrier();
  const std::string text = contents_of(folder / "probes.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "step,time [s],one temperature [K],one phase [1],\"a \"\"b\"\", c temperature [K]\",\"a \"\"b\"\", c phase "
            "[1]\"");
  const CsvTable table = read_csv(folder / "probes.csv");
  ASSERT_EQ(table.columns.size(), 6u);
  EXPECT_EQ(table.columns[4], "a \"b\", c temperature [K]");
  ASSERT_EQ(table.rows.size(), 8u);
  for (int step = 0; step <= last_step; ++step) {
    EXPECT_EQ(table.rows[step],
              (std::vector<double>{static_cast<double>(step), step * step_length, StandInMethod::temperature(1, step),
                                   -1.0, StandInMethod::temperature(23, step), -23.0}));
  }
  const auto places = nlohmann::json::parse(contents_of(folder / "probes.json"));
  EXPECT_EQ(places[0]["particle"], 1);
  EXPECT_EQ(places[0]["position_m"], (Point{1e-5, 0, 0}));
  EXPECT_EQ(places[1]["name"], "a \"b\", c");
  EXPECT_EQ(report.facts()["probes"][0]["temperature"]["highest"], StandInMethod::temperature(1, last_step));
  EXPECT_EQ(report.facts()["probes"][0]["temperature"]["highest_at_s"], last_step * step_length);
  EXPECT_EQ(report.facts()["probes"][0]["phase"]["last"], -1.0);
}

TEST(ProbeObserver, WritesEverySoManyStepsAndTheLastOne) {
  TestFolder folder;
  StandInMethod method;
  ProbeObserver observer(probe_list({{"one", {0, 0, 0}}}, 3), context_of(method, folder));
  run(observer, method, 0, last_step);
  RunReport report;
  observer.finish(report);
  world()->barrier();
  std::vector<double> steps;
  for (const auto& row : read_csv(folder / "probes.csv").rows) steps.push_back(row[0]);
  EXPECT_EQ(steps, (std::vector<double>{0, 3, 6, 7}));
}

TEST(ProbeObserver, HasItsRowsOnDiskWhenACheckpointIsWritten) {
  // Rows wait until the ranks exchange again, but for a machine that pauses at the wrong moment.
  constexpr int attempts = 20;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    TestFolder folder;
    StandInMethod method;
    ProbeObserver observer(probe_list({{"one", {0, 0, 0}}}), context_of(method, folder));
    run(observer, method, 0, 5);
    world()->barrier();
    const std::size_t before = read_csv(folder / "probes.csv").rows.size();
    world()->barrier();
    observer.observe({6, last_step, 6 * step_length, method.unknown(6), {}, true});
    world()->barrier();
    EXPECT_EQ(read_csv(folder / "probes.csv").rows.size(), 7u);
    world()->barrier();
    if (before == 2) return;
  }
  FAIL() << "rows 2 to 5 waited in none of " << attempts << " runs";
}

TEST(ProbeObserver, ARestartCutsLaterRowsAndContinues) {
  TestFolder whole, parts;
  StandInMethod method;
  const auto list = probe_list({{"one", {0, 0, 0}}});
  RunReport report_whole, report_parts;
  {
    ProbeObserver observer(list, context_of(method, whole));
    run(observer, method, 0, last_step);
    observer.finish(report_whole);
  }
  {
    ProbeObserver observer(list, context_of(method, parts));
    run(observer, method, 0, 5, 5);
  }
  world()->barrier();
  // A killed program may leave half a row.
  if (world()->getRank() == 0) std::ofstream(parts / "probes.csv", std::ios::app) << "6,0.6";
  world()->barrier();
  {
    ProbeObserver observer(list, context_of(method, parts, 3));
    run(observer, method, 3, last_step);
    observer.finish(report_parts);
  }
  world()->barrier();
  EXPECT_EQ(contents_of(parts / "probes.csv"), contents_of(whole / "probes.csv"));
  EXPECT_EQ(report_parts.facts(), report_whole.facts());
  ProbeObserver other(probe_list({{"other", {0, 0, 0}}}), context_of(method, parts, 3));
  EXPECT_THROW(run(other, method, 3, last_step), FileError);
}

TEST(ProbeObserver, ListsAllProbesOutside) {
  TestFolder folder;
  StandInMethod method;
  const auto list =
      probe_list({{"in", {0, 0, 0}}, {"left", {-1.1e-5, 0, 0}}, {"edge", {-0.99e-5, 0, 0}}, {"far", {0, 0, 1.0}}});
  try {
    ProbeObserver(list, context_of(method, folder));
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2u);
    EXPECT_EQ(error.problems()[0].path, "output.probes.points.1.position");
    EXPECT_EQ(error.problems()[1].path, "output.probes.points.3.position");
    EXPECT_NE(error.problems()[1].found.find("probe 'far' at (0, 0, 1) m is outside"), std::string::npos);
    EXPECT_NE(error.problems()[1].expected.find("[0, 3e-05] × [0, 2e-05] × [0, 1e-05] m"), std::string::npos)
        << error.what();
  }
  world()->barrier();
  EXPECT_FALSE(std::filesystem::exists(folder / "probes.csv")) << "nothing is written for an input with mistakes";
}

TEST(ProbeObserver, TheToleranceIsTheUsers) {
  TestFolder folder;
  StandInMethod method;
  auto list = probe_list({{"off", {0.3e-5, 0, 0}}});
  list.set("tolerance", 0.31e-5);
  EXPECT_NO_THROW(ProbeObserver(list, context_of(method, folder)));
  list.set("tolerance", 0.29e-5);
  EXPECT_THROW(ProbeObserver(list, context_of(method, folder)), InputError);
}

TEST(ProbeObserver, RefusesTwoProbesOfOneName) {
  const auto list = probe_list({{"one", {0, 0, 0}}, {"two", {0, 0, 0}}, {"one", {0, 0, 0}}});
  const Specification specification = ProbeObserver::specification();
  std::vector<Problem> problems;
  for (const auto& check : specification.checks()) check(list, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].path, "points.2.name");
}

TEST(FieldObserver, WritesEverySoManyStepsAndTheLastOne) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList list("output.fields");
  list.set("every", 3);
  RunReport report;
  {
    FieldObserver observer(list, context_of(method, folder));
    run(observer, method, 0, last_step);
    observer.finish(report);
  }
  EXPECT_EQ(report.facts()["fields"]["frames"], 4);
  const auto file = hdf5::File::read(folder / "run.h5", world());
  EXPECT_EQ(file.integers("step").values, (std::vector<long long>{0, 3, 6, 7}));
  const auto temperature = file.reals("temperature", {4, 24}).values;
  for (int id = 0; id < 24; ++id) EXPECT_EQ(temperature[2 * 24 + id], StandInMethod::temperature(id, 6));
  EXPECT_EQ(file.text("input"), "a: 1");
  EXPECT_EQ(file.text("method"), "fom");
  EXPECT_EQ(file.text("ranks"), std::to_string(world()->getSize()));
  EXPECT_FALSE(file.text("commit").empty());
}

/// However fast the frames come, and although the last one of the run is not reached.
TEST(FieldObserver, ListsAllFramesForParaViewAtTheEnd) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList list("output.fields");
  list.set("every", 1);
  RunReport report;
  FieldObserver observer(list, context_of(method, folder));
  run(observer, method, 0, 5);
  observer.finish(report);
  world()->barrier();
  const std::string xdmf = contents_of(folder / "run.xdmf");
  for (int step = 0; step <= 5; ++step) {
    EXPECT_NE(xdmf.find("/frame/temperature/" + std::to_string(step)), std::string::npos) << step;
  }
  world()->barrier();
}

TEST(FieldObserver, ARestartContinues) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList list("output.fields");
  list.set("every", 2);
  {
    FieldObserver observer(list, context_of(method, folder));
    run(observer, method, 0, 5);
  }
  {
    FieldObserver observer(list, context_of(method, folder, 3));
    run(observer, method, 3, last_step);
  }
  const auto file = hdf5::File::read(folder / "run.h5", world());
  EXPECT_EQ(file.integers("step").values, (std::vector<long long>{0, 2, 4, 6, 7}));
}

TEST(FieldObserver, KeepsTheCoordinatesOfAReducedMethod) {
  TestFolder folder;
  ReducedStandIn method;
  Teuchos::ParameterList list("output.fields");
  list.set("every", 4);
  {
    FieldObserver observer(list, context_of(method, folder));
    observer.begin();
    for (int step = 0; step <= last_step; ++step) {
      observer.observe({step, last_step, step * step_length, ReducedStandIn::reduced_unknown(step), {}});
    }
  }
  const auto file = hdf5::File::read(folder / "run.h5", world());
  EXPECT_EQ(file.reals("coordinates", {3, 3}).values, (std::vector<double>{0, 0, -0.0, 4, 8, -4, 7, 14, -7}));
  EXPECT_EQ(file.reals("temperature", {3, 24}).values[24 + 5], StandInMethod::temperature(5, 4));
}

TEST(FieldObserver, AFullStateHasNoCoordinates) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList list("output.fields");
  list.set("every", 7);
  {
    FieldObserver observer(list, context_of(method, folder));
    run(observer, method, 0, last_step);
  }
  EXPECT_FALSE(hdf5::File::read(folder / "run.h5", world()).has("coordinates"));
}

TEST(Extremes, FindsValueParticleAndTimeOnAnyRank) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList list("output.extremes");
  list.set("every", 2);
  RunReport report;
  Extremes observer(list, context_of(method, folder));
  run(observer, method, 0, last_step);
  observer.finish(report);
  if (world()->getRank() != 0) return;
  const nlohmann::json& temperature = report.facts()["observers"]["extremes"]["temperature"];
  EXPECT_EQ(temperature["largest"], StandInMethod::temperature(23, last_step));
  EXPECT_EQ(temperature["largest_particle"], 23);
  EXPECT_DOUBLE_EQ(temperature["largest_time_s"], last_step * step_length);
  EXPECT_EQ(temperature["smallest"], StandInMethod::temperature(0, 0));
  EXPECT_EQ(temperature["smallest_particle"], 0);
  EXPECT_EQ(report.facts()["observers"]["extremes"]["phase"]["smallest_particle"], 23);
  EXPECT_EQ(read_csv(folder.path() / "extremes.csv").rows.size(), 5u);
}

TEST(Extremes, ARestartKeepsEarlierRows) {
  TestFolder whole, parts;
  StandInMethod method;
  Teuchos::ParameterList list("output.extremes");
  list.set("every", 1);
  RunReport report_whole, report_parts;
  Extremes uninterrupted(list, context_of(method, whole));
  run(uninterrupted, method, 0, last_step);
  uninterrupted.finish(report_whole);
  {
    Extremes interrupted(list, context_of(method, parts));
    run(interrupted, method, 0, 5, 5);
  }
  world()->barrier();
  Extremes continued(list, context_of(method, parts, 3));
  run(continued, method, 3, last_step);
  continued.finish(report_parts);
  world()->barrier();
  EXPECT_EQ(contents_of(parts / "extremes.csv"), contents_of(whole / "extremes.csv"));
  EXPECT_EQ(report_parts.facts(), report_whole.facts());
}

TEST(Observers, ConstructorsTouchNoFile) {
  TestFolder folder;
  StandInMethod method;
  Teuchos::ParameterList every("output.every");
  every.set("every", 1);
  const FieldObserver fields(every, context_of(method, folder));
  const Extremes extremes(every, context_of(method, folder));
  const ProbeObserver probes(probe_list({{"one", {0, 0, 0}}}), context_of(method, folder));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Observers, AreRegisteredByTheirBlocksNames) {
  const auto names = catalogue::names(Observer::category);
  for (const char* name : {"extremes", "fields", "probes"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

std::string shown(bool terminal, int first_step, int end_step) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = open_memstream(&text, &size);
  {
    ProgressObserver progress("full order", first_step, stream, terminal);
    const VectorView nothing;
    for (int step = first_step == 0 ? 0 : first_step + 1; step <= end_step; ++step) {
      progress.observe({step, 1000, step * step_length, nothing, {}});
    }
    RunReport report;
    progress.finish(report);
    EXPECT_TRUE(report.facts().empty());
  }
  std::fclose(stream);
  const std::string result(text, size);
  std::free(text);
  return result;
}

TEST(ProgressObserver, PrintsALineEveryTenthWithoutATerminal) {
  const std::string text = shown(false, 0, 1000);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_EQ(text.substr(0, text.find(',')), "full order: 10 %");
  EXPECT_NE(text.find("100 %, step 1000 of 1000, 0 s in all\n"), std::string::npos) << text;
}

TEST(ProgressObserver, DrawsABarAtMostOnceASecond) {
  const std::string text = shown(true, 0, 1000);
  // A run of an instant: the first drawing and the last one.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 2) << text;
  EXPECT_NE(text.find("100% step 1000/1000, 0 s in all"), std::string::npos) << text;
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(shown(true, 0, 10).back(), '\n') << "a run that ends early leaves the terminal at a new line";
}

TEST(ProgressObserver, TellsDurations) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.6), "1:00");
  EXPECT_EQ(duration_text(125.0), "2:05");
  EXPECT_EQ(duration_text(3723.0), "1:02:03");
}

}  // namespace
}  // namespace kiln
