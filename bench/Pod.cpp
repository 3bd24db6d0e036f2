#include <cmath>

#include "bench/Figures.hpp"
#include "bench/Program.hpp"
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

int main(int argc, char** argv) {
  using namespace kiln::bench;
  return program(argc, argv, {"bench_pod pod FOLDER: writes FOLDER/pod.json"}, {2},
                 [](const Words& words, const auto& communicator) {
                   write(words[1] + "/" + words[0] + ".json", measure(*communicator), kiln::provenance(*communicator));
                 });
}
