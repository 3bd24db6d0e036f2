#include "bench/MachineLimits.hpp"

#include <memory>
#include <vector>

#include "physics/sph/PairSum.hpp"

namespace kiln::bench {
namespace {

constexpr int pairs = 512;
constexpr int repeats = 4000;

struct Pairs {
  alignas(64) double temperature[pairs], resistivity[pairs], volume[pairs], weight[pairs];
  double result = 0.0;
};

std::shared_ptr<Pairs> some_pairs() {
  auto result = std::make_shared<Pairs>();
  for (int p = 0; p < pairs; ++p) {
    result->temperature[p] = 300.0 + p;
    result->resistivity[p] = 0.05 + 1e-5 * p;
    result->volume[p] = 1.0;
    result->weight[p] = -1.0;
  }
  return result;
}

}  // namespace

Limit stream_triad() {
  constexpr std::size_t count = std::size_t{32} << 20;
  auto a = std::make_shared<std::vector<double>>(count, 0.0);
  auto b = std::make_shared<std::vector<double>>(count, 1.0);
  auto c = std::make_shared<std::vector<double>>(count, 2.0);
  return {[=] {
            double* to = a->data();
            const double* x = b->data();
            const double* y = c->data();
            for (std::size_t i = 0; i < count; ++i) to[i] = x[i] + 3.0 * y[i];
          },
          24.0 * count};
}

Limit pair_mix() {
  auto all = some_pairs();
  return {[all] {
            Pairs& p = *all;
            double total = 0.0;
            for (int repeat = 0; repeat < repeats; ++repeat) {
              const double u_i = 1000.0 + repeat;
              const double resistivity_i = 0.06;
              double sum = 0.0;
#pragma omp simd reduction(+ : sum)
              for (int j = 0; j < pairs; ++j) {
                sum += p.weight[j] * p.volume[j] * (u_i - p.temperature[j]) / (resistivity_i + p.resistivity[j]);
              }
              total += sum;
            }
            p.result = total;
          },
          operations_per_pair * pairs * repeats};
}

Limit shared_pair_mix() {
  auto all = some_pairs();
  return {[all] {
            Pairs& p = *all;
            double total = 0.0;
            for (int repeat = 0; repeat < repeats; ++repeat) {
#ifdef KILN_LANES
              const Lanes u_i = all_lanes(1000.0 + repeat);
              const Lanes resistivity_i = all_lanes(0.06);
              const auto term = [&](int j) {
                return pair_term<PairQuantity::flux>(u_i, resistivity_i, lanes_at(p.temperature + j),
                                                     lanes_at(p.resistivity + j), lanes_at(p.volume + j));
              };
              const auto two = [&](int j) { return (term(j) + term(j + lane_count)).weighted(p.weight[j]); };
              Lanes sum = {};
              for (int j = 0; j < pairs; j += 8 * lane_count) {
                sum +=
                    ((two(j) + two(j + 2 * lane_count)) + (two(j + 4 * lane_count) + two(j + 6 * lane_count))).value();
              }
              total += lane_sum(sum);
#else
              PairTerm<double> term = {0.0, 1.0};
              for (int j = 0; j < pairs; ++j) {
                term = term + pair_term<PairQuantity::flux>(1000.0 + repeat, 0.06, p.temperature[j], p.resistivity[j],
                                                            p.volume[j])
                                  .weighted(p.weight[j]);
                if (j % 8 != 7) continue;
                total += term.value();
                term = {0.0, 1.0};
              }
#endif
            }
            p.result = total;
          },
          operations_per_pair * pairs * repeats};
}

}  // namespace kiln::bench
