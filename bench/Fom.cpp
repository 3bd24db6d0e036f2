#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bench/BenchCase.hpp"
#include "bench/Figures.hpp"
#include "bench/MachineLimits.hpp"
#include "bench/PlainRate.hpp"
#include "bench/Program.hpp"
#include "framework/model/Halo.hpp"
#include "framework/report/Provenance.hpp"

namespace kiln::bench {
namespace {

constexpr int runs = 15;
/// What a kernel's answers may differ from the plain loop's, relative to the largest rate.
constexpr double same_answer = 1e-12;

Teuchos::RCP<const Communicator> alone() {
  const auto everyone = Tpetra::getDefaultComm();
  const int rank = everyone->getRank();
  return everyone->createSubcommunicator(Teuchos::ArrayView<const int>(&rank, 1));
}

/// Long before the beam, so that no power is absorbed: the plain loop has no heat source.
constexpr double no_beam = -1.0;

/// Makes u another state than that of the call before, of which a model would still know the sums.
void change(const VectorView& u) { u(0) = u(0) == 1000.0 ? 1001.0 : 1000.0; }

void rate_anew(const Model& model, const VectorView& u, const VectorView& f) {
  change(u);
  model.rate(u, no_beam, f);
}

void require_same(const char* what, const HeatModel& model, const PlainRate& plain, const VectorView& f) {
  double largest = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < f.extent(0); ++i) {
    largest = std::max(largest, std::abs(plain.rate()[i]));
    difference = std::max(difference, std::abs(f(i) - plain.rate()[i]));
  }
  if (difference <= same_answer * largest) return;
  throw std::runtime_error(
      fmt::format("{} ({}): differs from the plain loop by {:.2e} of the largest rate; expected {}", what,
                  model.layout().name(), difference / largest, same_answer));
}

/// A limit of the machine and how much of it one evaluation needs, in the limit's units.
struct Need {
  Limit limit;
  double amount;
};

/// One arrangement of the particles against the plain loop, and against what the machine takes for the slowest of
/// `needs`, measured in the same runs.
void arrangement(std::vector<Figure>& figures, const std::string& name, const HeatModel& model,
                 const std::vector<Need>& needs) {
  PlainRate plain(model);
  const VectorView u = weld_state(model);
  const VectorView f("f", local_size(*model.rows()));
  plain.evaluate(u);
  model.rate(u, no_beam, f);
  require_same(name.c_str(), model, plain, f);
  const auto seconds = interleaved(runs, {[&] { plain.evaluate(u); }, [&] { rate_anew(model, u, f); },
                                          [&] {
                                            change(u);
                                            model.rate_jacobian_diagonal(u, no_beam, f);
                                          }});
  // Apart from the comparison above: the triad leaves the caches cold.
  std::vector<std::function<void()>> works = {[&] { rate_anew(model, u, f); }};
  for (const Need& need : needs) works.push_back(need.limit.work);
  const auto beside_limits = interleaved(runs, works);
  std::vector<double> limits(runs, 0.0);
  for (std::size_t n = 0; n < needs.size(); ++n) {
    for (int run = 0; run < runs; ++run) {
      limits[run] = std::max(limits[run], needs[n].amount / needs[n].limit.amount * beside_limits[1 + n][run]);
    }
  }
  const double per_pair = 1e9 / static_cast<double>(plain.pairs());
  const std::string prefix = "fom." + name;
  if (name == "lattice") figures.push_back({"fom.plain.ns_per_pair", "ns", scaled(seconds[0], per_pair)});
  figures.push_back({prefix + ".ns_per_pair", "ns", scaled(seconds[1], per_pair)});
  figures.push_back({prefix + ".vs_plain", "x", ratios(seconds[0], seconds[1])});
  figures.push_back({prefix + ".fraction_of_limit", "", ratios(limits, beside_limits[0])});
  figures.push_back({prefix + ".diagonal_to_rate", "x", ratios(seconds[2], seconds[1])});
}

/// A sample mesh as hyper-reduction evaluates it: 120 rows in five bricks of 4 x 3 x 2.
void sample_mesh(std::vector<Figure>& figures, const HeatModel& model, const BenchCase& part) {
  std::vector<GlobalIndex> rows;
  for (int brick = 0; brick < 5; ++brick) {
    for (int n = 0; n < 24; ++n) {
      const int x = 10 + 18 * brick + n % 4;
      const int y = 20 + n / 4 % 3;
      const int z = part.count[2] - 1 - n / 12;
      rows.push_back(x + static_cast<GlobalIndex>(part.count[0]) * (y + part.count[1] * z));
    }
  }
  const auto sample = model.sampled(rows);
  const VectorView u = weld_state(model);
  const VectorView f("f", local_size(*model.rows()));
  const VectorView sample_u = weld_state(*sample);
  const VectorView sample_f("f", rows.size());
  constexpr int repeats = 100;
  const auto seconds = interleaved(runs, {[&] { rate_anew(model, u, f); },
                                          [&] {
                                            for (int n = 0; n < repeats; ++n) rate_anew(*sample, sample_u, sample_f);
                                          }});
  const double pairs = static_cast<double>(dynamic_cast<const HeatModel&>(*sample).domain().pairs.neighbours.extent(0));
  figures.push_back({"fom.sample_mesh.ns_per_pair", "ns", scaled(seconds[1], 1e9 / (pairs * repeats))});
  const double full_pairs = static_cast<double>(model.domain().pairs.neighbours.extent(0));
  figures.push_back(
      {"fom.sample_mesh.to_cloud", "x", scaled(ratios(seconds[1], seconds[0]), full_pairs / (pairs * repeats))});
}

std::vector<Figure> one_rank(const std::string& folder) {
  std::vector<Figure> figures;
  const Limit triad = stream_triad();
  const Limit mix = pair_mix();
  const Limit shared = shared_pair_mix();
  const auto seconds = interleaved(5, {triad.work, mix.work, shared.work});
  const auto rates = [](const Limit& limit, const std::vector<double>& times) {
    std::vector<double> result;
    for (const double time : times) result.push_back(1e-9 * limit.amount / time);
    return result;
  };
  figures.push_back({"machine.stream_gb_s", "GB/s", rates(triad, seconds[0])});
  figures.push_back({"machine.pair_mix_gflops", "Gflop/s", rates(mix, seconds[1])});
  figures.push_back({"machine.shared_pair_mix_gflops", "Gflop/s", rates(shared, seconds[2])});
  const auto communicator = Tpetra::getDefaultComm();
  const BenchCase part;
  {
    const auto model = part.lattice(communicator);
    const double pairs = static_cast<double>(model->domain().pairs.neighbours.extent(0));
    // Nothing but states is read: arithmetic is the limit.
    arrangement(figures, "lattice", *model, {{shared, pairs * operations_per_pair}});
  }
  const auto model = part.cloud(communicator, folder + "/cloud.csv");
  const double pairs = static_cast<double>(model->domain().pairs.neighbours.extent(0));
  // Each pair is read once: a weight and an index; its term serves both particles.
  arrangement(figures, "cloud", *model,
              {{mix, 0.5 * pairs * operations_per_pair},
               {triad, 0.5 * pairs * static_cast<double>(sizeof(double) + sizeof(LocalIndex))}});
  sample_mesh(figures, *model, part);
  return figures;
}

/// A residual's rate with its halo exchange on all ranks, and on one rank in turn.
std::vector<Figure> all_ranks() {
  const auto everyone = Tpetra::getDefaultComm();
  const BenchCase part;
  const auto single = part.lattice(alone());
  const auto shared = part.lattice(everyone);
  const VectorView single_u = weld_state(*single);
  const VectorView single_f("f", local_size(*single->rows()));
  const Halo halo(*shared);
  Halo::State state(halo);
  const VectorView shared_u = weld_state(*shared);
  Kokkos::deep_copy(state.rows(), Kokkos::subview(shared_u, std::make_pair(LocalIndex(0), halo.row_size())));
  const VectorView shared_f("f", halo.row_size());
  const auto wall = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  constexpr int repeats = 10;
  Figure ratio = {"fom.two_ranks", "x", {}};
  Figure work = {"fom.two_ranks.without_exchange_cpu", "x", {}};
  for (int run = -1; run < runs; ++run) {
    everyone->barrier();
    double start = wall();
    double cpu = thread_seconds();
    if (everyone->getRank() == 0) {
      for (int n = 0; n < repeats; ++n) rate_anew(*single, single_u, single_f);
    }
    const double one_cpu = thread_seconds() - cpu;
    everyone->barrier();
    const double one = wall() - start;
    start = wall();
    double rate_cpu = 0.0;
    for (int n = 0; n < repeats; ++n) {
      state.fill();
      cpu = thread_seconds();
      rate_anew(*shared, state.sources(), shared_f);
      rate_cpu += thread_seconds() - cpu;
    }
    everyone->barrier();
    const double all = wall() - start;
    double slowest = 0.0;
    Teuchos::reduceAll(*everyone, Teuchos::REDUCE_MAX, 1, &rate_cpu, &slowest);
    if (run < 0) continue;
    ratio.runs.push_back(one / all);
    work.runs.push_back(one_cpu / slowest);
  }
  return {ratio, work};
}

/// Time of an evaluation and memory over growing parts, evaluated in turn: a machine that is slower for a while is so
/// for all.
std::vector<Figure> scale() {
  struct Part {
    std::string name;
    std::shared_ptr<HeatModel> model;
    VectorView u, f;
    double pairs;
    int repeats;
  };
  const std::vector<std::pair<std::string, BenchCase>> cases = {
      {"9k", {{50, 25, 7}}}, {"70k", {{100, 50, 14}}}, {"560k", {{200, 100, 28}}}, {"1890k", {{300, 150, 42}}}};
  std::vector<Part> parts;
  std::vector<std::function<void()>> evaluations;
  for (const auto& [name, part] : cases) {
    const std::shared_ptr<HeatModel> model = part.lattice(Tpetra::getDefaultComm());
    const VectorView f("f", local_size(*model->rows()));
    const int repeats = std::max(1, static_cast<int>(280000.0 / static_cast<double>(f.extent(0))));
    const auto pairs = static_cast<double>(model->domain().pairs.neighbours.extent(0));
    parts.push_back({name, model, weld_state(*model), f, pairs, repeats});
    evaluations.emplace_back([each = parts.back()] {
      for (int n = 0; n < each.repeats; ++n) rate_anew(*each.model, each.u, each.f);
    });
  }
  const auto seconds = interleaved(runs, evaluations);
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto& [name, model, u, f, pairs, repeats] = parts[k];
    const auto particles = static_cast<double>(f.extent(0));
    figures.push_back({"scale.fom_ns_per_pair_" + name, "ns", scaled(seconds[k], 1e9 / (pairs * repeats))});
    const double listed = pairs * (sizeof(double) + sizeof(LocalIndex)) + particles * sizeof(std::size_t);
    figures.push_back({"scale.pair_list_bytes_per_particle_" + name, "B", {listed / particles}});
    figures.push_back(
        {"scale.layout_bytes_per_particle_" + name, "B", {static_cast<double>(model->layout().bytes()) / particles}});
  }
  return figures;
}

/// Evaluates with one kernel on a small part, for an instruction counter; prints how many pairs it went through.
void count(const std::string& kernel, int repeats, const std::string& folder) {
  const auto communicator = Tpetra::getDefaultComm();
  const BenchCase part = {{40, 30, 14}};
  const auto model = kernel == "lattice" ? part.lattice(communicator) : part.cloud(communicator, folder + "/count.csv");
  PlainRate plain(*model);
  const auto rows = sliced_rows(model->domain());
  const VectorView u = weld_state(*model);
  const VectorView f("f", local_size(*model->rows()));
  const ThermalStateView states("states", u.extent(0) + 1);
  for (std::size_t j = 0; j < u.extent(0); ++j) {
    states(j) = thermal_state(model->material(), u(j), model->domain().masses(j));
  }
  states(u.extent(0)) = nobody;
  for (int n = 0; n < repeats; ++n) {
    if (kernel == "plain") {
      plain.evaluate(u);
    } else if (kernel == "rows") {
      rows->sum(PairQuantity::flux, states, f);
    } else {
      rate_anew(*model, u, f);
    }
  }
  fmt::print("pairs {}\n", plain.pairs() * static_cast<std::size_t>(repeats));
}

}  // namespace
}  // namespace kiln::bench

int main(int argc, char** argv) {
  using namespace kiln::bench;
  const Words usage = {"bench_fom one|ranks|scale FOLDER: writes FOLDER/<what>.json",
                       "bench_fom count-KERNEL FOLDER REPEATS: evaluates only"};
  return program(argc, argv, usage, {2, 3}, [](const Words& words, const auto& communicator) {
    const std::string &what = words[0], &folder = words[1];
    if (what.rfind("count-", 0) == 0) return count(what.substr(6), std::stoi(words.at(2)), folder);
    std::vector<Figure> figures;
    if (what == "one") {
      figures = one_rank(folder);
    } else if (what == "ranks") {
      figures = all_ranks();
    } else if (what == "scale") {
      figures = scale();
    } else {
      throw std::invalid_argument(fmt::format("bench_fom: '{}'; expected one, ranks or scale", what));
    }
    const nlohmann::json machine = kiln::provenance(*communicator);
    if (communicator->getRank() == 0) write(folder + "/" + what + ".json", figures, machine);
  });
}
