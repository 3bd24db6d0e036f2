#include "framework/files/RunFile.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "framework/base/Error.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

constexpr int particles = 60;
constexpr double time_step = 0.25;

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

/// Particles dealt to the ranks like cards.
class SampleRun {
 public:
  SampleRun() {
    for (GlobalIndex id = particles - 1; id >= 0; --id) {
      if (id % world()->getSize() == world()->getRank()) ids.push_back(id);
    }
    map = Teuchos::rcp(new Map(particles, ids.data(), static_cast<LocalIndex>(ids.size()), 0, world()));
    positions = PositionView("kiln::test::positions", ids.size());
    const auto host = Kokkos::create_mirror_view(positions);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      for (int d = 0; d < 3; ++d) host(i, d) = 1e-6 * (static_cast<double>(ids[i]) + 0.1 * d);
    }
    Kokkos::deep_copy(positions, host);
  }
  /// read_back.py knows these values too.
  VectorView state(int step) const {
    VectorView u("kiln::test::state", 2 * ids.size());
    const auto host = Kokkos::create_mirror_view(u);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      host(2 * i) = 293.15 + static_cast<double>(ids[i]) / 3.0 + 100.0 * step;
      host(2 * i + 1) = -static_cast<double>(ids[i]) - 1000.0 * step;
    }
    Kokkos::deep_copy(u, host);
    return u;
  }
  static RunFile::Contents contents() {
    return {
        {{"temperature", "K"}, {"enthalpy", "J/kg"}}, {0, 2, 4, 5}, {{"kiln", "0.1.0"}, {"input", "a: <1 & \"2\">"}}};
  }
  RunFile open(const std::string& folder, int first_step, RunFile::Contents contents = SampleRun::contents()) const {
    return RunFile(folder, *map, positions, std::move(contents), first_step, world());
  }
  void write(RunFile& file, int step) const { file.write(step, step * time_step, state(step)); }

  std::vector<GlobalIndex> ids;
  Teuchos::RCP<const Map> map;
  PositionView positions;
};

template <class Work>
std::string file_error(Work&& work) {
  try {
    work();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

std::string contents_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The files that read_back.py reads: all frames but the last, as a run killed before its end leaves them.
TEST(RunFile, LeavesFilesForTheReaders) {
  const char* folder = std::getenv("KILN_READ_BACK_FOLDER");
  if (folder == nullptr) GTEST_SKIP() << "KILN_READ_BACK_FOLDER is not set";
  if (world()->getRank() == 0) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  world()->barrier();
  const SampleRun run;
  RunFile file = run.open(folder, 0);
  for (const int step : {0, 2, 4}) run.write(file, step);
  file.write_xdmf();
  EXPECT_EQ(file.frames_written(), 3u);
}

TEST(RunFile, CanBeReadWhileTheRunStillWritesIt) {
  TestFolder folder;
  const SampleRun run;
  RunFile file = run.open(folder.path(), 0);
  run.write(file, 0);
  world()->barrier();
  {
    const auto reader = hdf5::File::read(folder / "run.h5", world());
    const auto times = reader.reals("time", {4}).values;
    EXPECT_EQ(times[0], 0.0);
    EXPECT_TRUE(std::isnan(times[1]) && std::isnan(times[3]));
    EXPECT_EQ(reader.reals("temperature", {4, particles}).values[7], 293.15 + 7.0 / 3.0);
  }
  world()->barrier();
  run.write(file, 2);
}

TEST(RunFile, ARestartContinuesTheFile) {
  TestFolder whole, parts;
  const SampleRun run;
  {
    RunFile file = run.open(whole.path(), 0);
    for (const int step : {0, 2, 4, 5}) run.write(file, step);
    file.write_xdmf();
  }
  {
    RunFile file = run.open(parts.path(), 0);
    // Step 4 was written after the checkpoint at step 3, by the run that was then killed.
    for (const int step : {0, 2, 4}) run.write(file, step);
  }
  {
    RunFile file = run.open(parts.path(), 3);
    EXPECT_EQ(file.frames_written(), 2u);
    for (const int step : {4, 5}) run.write(file, step);
    file.write_xdmf();
  }
  const auto expected = hdf5::File::read(whole / "run.h5", world());
  const auto found = hdf5::File::read(parts / "run.h5", world());
  for (const char* name : {"time", "temperature", "enthalpy", "position"}) {
    EXPECT_EQ(found.reals(name).values, expected.reals(name).values) << name;
  }
  EXPECT_EQ(found.integers("step").values, (std::vector<long long>{0, 2, 4, 5}));
  EXPECT_EQ(contents_of(parts / "run.xdmf"), contents_of(whole / "run.xdmf"));
}

TEST(RunFile, ARestartForgetsLaterFrames) {
  TestFolder folder;
  const SampleRun run;
  {
    RunFile file = run.open(folder.path(), 0);
    for (const int step : {0, 2, 4, 5}) run.write(file, step);
  }
  run.open(folder.path(), 2);
  const auto file = hdf5::File::read(folder / "run.h5", world());
  EXPECT_EQ(file.integers("step").values, (std::vector<long long>{0, 2, -1, -1}));
  EXPECT_TRUE(std::isnan(file.reals("time").values[2]));
}

TEST(RunFile, ARestartRefusesAnotherRunsFile) {
  TestFolder folder;
  const SampleRun run;
  { run.open(folder.path(), 0); }
  RunFile::Contents longer = SampleRun::contents();
  longer.steps.push_back(6);
  const std::string text = file_error([&] { run.open(folder.path(), 2, longer); });
  EXPECT_NE(text.find("/temperature: has shape 4 × 60; expected 5 frames × 60 particles"), std::string::npos) << text;
  RunFile::Contents other = SampleRun::contents();
  other.fields[0].name = "pressure";
  EXPECT_NE(file_error([&] { run.open(folder.path(), 2, other); }).find("/pressure: is missing"), std::string::npos);
  TestFolder empty;
  EXPECT_NE(file_error([&] { run.open(empty.path(), 2); }).find("No such file"), std::string::npos);
}

TEST(RunFile, RefusesAStepThatWasNotPlanned) {
  TestFolder folder;
  const SampleRun run;
  RunFile file = run.open(folder.path(), 0);
  EXPECT_THROW(run.write(file, 3), std::logic_error);
}

}  // namespace
}  // namespace kiln
