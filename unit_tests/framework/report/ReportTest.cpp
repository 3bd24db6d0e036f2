#include <dlfcn.h>
#include <gtest/gtest.h>

#include <Teuchos_StackedTimer.hpp>
#include <Tpetra_Core.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "framework/report/Provenance.hpp"
#include "framework/report/ReportText.hpp"
#include "framework/report/Timing.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

/// Keeps the processor busy; the sum keeps the compiler from dropping the loop.
double work_for(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  double sum = 0.0;
  while (std::chrono::steady_clock::now() < end) sum += 1.0;
  return sum;
}

/// Takes memory and gives it back; writes that the compiler must not drop make it resident.
void hold(long long bytes) {
  std::vector<char> block(static_cast<std::size_t>(bytes));
  volatile char* const values = block.data();
  for (long long i = 0; i < bytes; i += 4096) values[i] = 'x';
}

TEST(PeakMemory, BeginsAnewWhenReset) {
  if (!std::ofstream("/proc/self/clear_refs")) GTEST_SKIP() << "this system keeps the peak";
  constexpr long long size = 256LL << 20;
  hold(size);
  const long long before = peak_memory(*world());
  reset_peak_memory();
  const long long after = peak_memory(*world());
  EXPECT_LT(after, before - size / 2);
  hold(size);
  EXPECT_GT(peak_memory(*world()), after + size / 2);
}

TEST(Provenance, NamesWhatTheResultsComeFrom) {
  const nlohmann::json facts = provenance(*world());
  for (const char* key : {"kiln", "commit", "compiler", "build_flags", "trilinos", "kokkos", "execution_space", "hdf5",
                          "mpi", "blas", "processor", "kernel", "date", "host"}) {
    ASSERT_TRUE(facts.contains(key) && facts[key].is_string()) << key;
    EXPECT_FALSE(facts[key].get<std::string>().empty()) << key;
  }
  EXPECT_EQ(facts["ranks"], world()->getSize());
  EXPECT_GE(facts["cores"].get<int>(), 1);
  EXPECT_NE(facts["blas"].get<std::string>().find("blas"), std::string::npos) << facts["blas"];
  const bool is_openblas = dlsym(RTLD_DEFAULT, "openblas_get_config") != nullptr;
  EXPECT_EQ(facts.contains("openblas"), is_openblas);
  EXPECT_EQ(facts["date"].get<std::string>().size(), std::string("2022-01-01T00:00:00Z").size());
}

TEST(Timing, CountsTheProcessorTimeOfAllThreadsAndRanks) {
  const Stopwatch stopwatch;
  std::thread other([] { EXPECT_GT(work_for(0.1), 0.0); });
  EXPECT_GT(work_for(0.1), 0.0);
  other.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GE(stopwatch.wall_seconds(), 0.2);
  // Sleeping costs no processor time, and the threads may have had to share one core with other work.
  const double mine = stopwatch.process_seconds();
  EXPECT_GT(mine, 0.01);
  EXPECT_LT(mine, 2.0 * stopwatch.wall_seconds());
  const double all = stopwatch.cpu_seconds(*world());
  EXPECT_GE(all, mine);
  EXPECT_GT(all, 0.01 * world()->getSize());
  EXPECT_GT(peak_memory(*world()), 1 << 20);
}

TEST(Timing, ShowsTheTimersTable) {
  Teuchos::StackedTimer timer("run");
  timer.start("solve");
  timer.stop("solve");
  timer.stopBaseTimer();
  const std::string table = table_of(timer, world());
  EXPECT_EQ(table.find("solve") != std::string::npos, world()->getRank() == 0) << table;
}

TEST(ReportText, IsAnAlignedTableWithUnits) {
  const nlohmann::json report = {
      {"run",
       {{"wall_s", 12.3456789},
        {"steps", 1000},
        {"peak_kelvin", 2440.25},
        {"blas", "libopenblas"},
        {"wrong", nullptr}}},
      {"fom", {{"ns_cpu_per_pair", 2.5}, {"memory_bytes", 3.0 * 1024 * 1024}, {"touched_percent", 1.5}, {"ok", true}}},
      {"probes",
       {{{"name", "probe 1"},
         {"position_m", {0.001, 0.0, 0.5}},
         {"temperature", {{"unit", "K"}, {"highest", 900.5}, {"highest_at_s", 0.004}}}}}}};
  EXPECT_EQ(readable(report),
            "fom\n"
            "  memory                            3 MiB\n"
            "  cpu per pair                      2.5 ns\n"
            "  ok                                yes\n"
            "  touched                           1.5 %\n"
            "\n"
            "probes\n"
            "  probe 1, position                 (0.001, 0, 0.5) m\n"
            "  probe 1, temperature, highest     900.5 K\n"
            "  probe 1, temperature, highest at  0.004 s\n"
            "\n"
            "run\n"
            "  blas                              libopenblas\n"
            "  peak                              2440.25 K\n"
            "  steps                             1000\n"
            "  wall                              12.3457 s\n"
            "  wrong                             not a number\n");
}

TEST(ReportText, ShowsTablesOfSeveralLinesAsTheyAre) {
  const std::string text = readable({{"timing", {{"wall_s", 1.0}, {"table", "run: 1\n  solve: 1\n"}}}});
  EXPECT_EQ(text, "timing\n  wall  1 s\nrun: 1\n  solve: 1\n");
}

}  // namespace
}  // namespace kiln
