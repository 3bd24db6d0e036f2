#include "rom/pod/Truncation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/Error.hpp"

namespace kiln {
namespace {

constexpr const char* squared = "squared singular values";
constexpr const char* plain = "singular values";

PodSettings::Algorithm algorithm_of(const std::string& name) {
  if (name == "tsqr") return PodSettings::Algorithm::tsqr;
  return name == "randomised" ? PodSettings::Algorithm::randomised : PodSettings::Algorithm::gram;
}

}  // namespace

PodSettings::PodSettings(const Teuchos::ParameterList& list)
    : path(list.name()),
      algorithm(algorithm_of(list.get<std::string>("algorithm"))),
      energy_of(list.get<std::string>("energy_of") == plain ? EnergyOf::singular_values
                                                            : EnergyOf::squared_singular_values) {
  if (list.isParameter("rank")) rank = list.get<int>("rank");
  if (list.isParameter("energy")) energy = list.get<double>("energy");
}

Specification PodSettings::specification() {
  Specification s;
  s.integer("rank", "number of basis vectors; either this or energy").at_least(1).optional();
  s.real("energy", "fraction of the statistical energy to keep, e.g. 99.999 %").above(0).at_most(1).optional();
  s.choice("energy_of", "what the energy sums up", {squared, plain}).defaults_to(squared);
  s.choice(
       "algorithm",
       "gram: eigenvectors of the snapshots' Gram matrix; tsqr: parallel QR, for small singular values; randomised: "
       "projection on random combinations, for few vectors of very many snapshots",
       {"gram", "tsqr", "randomised"})
      .defaults_to("gram");
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    const bool by_rank = list.isParameter("rank"), by_energy = list.isParameter("energy");
    if (by_rank && by_energy) problems.push_back({"rank", "both rank and energy are given", "one of the two", {}});
    if (by_energy && list.get<std::string>("algorithm") == "randomised") {
      problems.push_back(
          {"energy", "a randomised decomposition has to be told how many vectors it shall find", "rank", {}});
    }
    if (!by_rank && !by_energy) problems.push_back({"", "neither rank nor energy is given", "one of the two", {}});
  });
  return s;
}

double PodSettings::resolution(std::size_t snapshots) const {
  const double round_off =
      std::numeric_limits<double>::epsilon() * static_cast<double>(std::max<std::size_t>(10, snapshots));
  return algorithm == Algorithm::gram ? std::sqrt(round_off) : 10.0 * round_off;
}

Truncation truncate(const std::vector<double>& singular_values, std::size_t snapshots, const PodSettings& settings,
                    std::optional<std::size_t> held) {
  const double resolution = settings.resolution(snapshots);
  const double floor = singular_values.empty() ? 0.0 : resolution * singular_values.front();
  const auto end = std::find_if(singular_values.begin(), singular_values.end(),
                                [floor](double sigma) { return !(sigma > floor) || !(sigma > 0.0); });
  const int independent = static_cast<int>(end - singular_values.begin());
  if (independent == 0) {
    throw InputError(settings.path, fmt::format("all {} snapshots are zero", snapshots),
                     "snapshots that differ from the reference state");
  }
  if (settings.rank && *settings.rank > independent && !settings.rank_is_cap) {
    const bool holds = held && *held < snapshots;
    throw InputError(
        settings.path + ".rank",
        fmt::format("{} basis vectors are asked for, but of {} snapshots{} only {} are independent (singular "
                    "values above {:.1e} of the largest)",
                    *settings.rank, snapshots,
                    holds ? fmt::format(", of which snapshots.hold left {} columns,", *held) : "", independent,
                    resolution),
        fmt::format("a rank of at most {}{}", independent, holds ? ", or a larger snapshots.hold" : ""));
  }
  const auto weight = [&settings](double sigma) {
    return settings.energy_of == PodSettings::EnergyOf::singular_values ? sigma : sigma * sigma;
  };
  double total = 0.0;
  for (int k = 0; k < independent; ++k) total += weight(singular_values[k]);
  double kept = 0.0;
  int rank = 0;
  const auto enough = [&] {
    if (settings.rank) return rank == *settings.rank;
    return rank >= settings.at_least && kept >= settings.energy.value_or(1.0) * total;
  };
  while (rank < independent && !enough()) kept += weight(singular_values[rank++]);
  return {rank, independent, kept / total};
}

}  // namespace kiln
