#include <dlfcn.h>
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <cmath>

#include "bench/Figures.hpp"
#include "framework/report/Provenance.hpp"
#include "rom/pod/Pod.hpp"

namespace kiln::bench {
namespace {

constexpr std::size_t rows = 70000;
constexpr std::size_t columns = 1000;
constexpr int runs = 5;

/// A warm spot that moves over a line of particles and leaves a wake: singular values that fall smoothly through all
/// the digits of a double.
Snapshots moving_spot() {
  Snapshots snapshots(rows);
  const VectorView column("column", rows);
  for (std::size_t n = 0; n < columns; ++n) {
    const double spot = static_cast<double>(n) / columns;
    for (std::size_t i = 0; i < rows; ++i) {
      const double distance = (static_cast<double>(i) / rows - spot) / 0.02;
      column(i) = std::exp(-0.5 * distance * distance) + 0.3 / (1.0 + std::exp(4.0 * distance));
    }
    snapshots.append(column);
  }
  return snapshots;
}

std::vector<Figure> measure(const Communicator& communicator) {
  using Algorithm = PodSettings::Algorithm;
  std::vector<Figure> figures = {{"pod.gram_s", "s", {}}, {"pod.tsqr_s", "s", {}}, {"pod.randomised_s", "s", {}}};
  const std::vector<Algorithm> algorithms = {Algorithm::gram, Algorithm::tsqr, Algorithm::randomised};
  for (int run = 0; run < runs; ++run) {
    for (std::size_t a = 0; a < algorithms.size(); ++a) {
      const Snapshots snapshots = moving_spot();
      PodSettings settings;
      settings.algorithm = algorithms[a];
      settings.rank = 20;
      const double start = thread_seconds();
      pod(snapshots, settings, communicator);
      figures[a].runs.push_back(thread_seconds() - start);
    }
  }
  return figures;
}

}  // namespace
}  // namespace kiln::bench

/// bench_pod pod FOLDER: writes FOLDER/pod.json.
int main(int argc, char** argv) {
  // As kiln itself does.
  const auto set_threads = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(1);
  Tpetra::ScopeGuard guard(&argc, &argv);
  if (argc != 3) {
    fmt::print(stderr, "bench_pod: {} arguments; expected: pod FOLDER\n", argc - 1);
    return EXIT_FAILURE;
  }
  const auto communicator = Tpetra::getDefaultComm();
  try {
    const auto figures = kiln::bench::measure(*communicator);
    kiln::bench::write(fmt::format("{}/{}.json", argv[2], argv[1]), figures, kiln::provenance(*communicator));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
