#include "rom/sampling/Greedy.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/sampling/GrowingLeastSquares.hpp"

namespace kiln {
namespace {

constexpr double tie = 1e-6;

/// The particles of all ranks with an error each, from which the worst is taken again and again.
class Candidates {
 public:
  Candidates(const Map& rows, ConstMatrixView modes, int components)
      : rows_(rows),
        modes_(modes),
        components_(components),
        standing_(local_size(rows), Standing::free),
        errors_(standing_.size(), 0.0),
        misfit_("kiln::rom::misfit", modes.extent(0)) {}

  void clear_errors() { std::fill(errors_.begin(), errors_.end(), 0.0); }

  /// Adds (R[:, column] − R[:, 0:b] α)² to the particles' errors, b the length of α.
  void add_misfit(int column, const std::vector<double>& alpha) {
    std::copy_n(&modes_(0, column), misfit_.extent(0), misfit_.data());
    const ConstVectorView coefficients(alpha.data(), alpha.size());
    dense::multiply(-1.0, dense::leading_columns(modes_, alpha.size()), coefficients, 1.0, misfit_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      for (int c = 0; c < components_; ++c) {
        const double value = misfit_(i * components_ + c);
        errors_[i] += value * value;
      }
    }
  }

  /// Twins of those taken come last.
  GlobalIndex worst() const {
    const GlobalIndex found = worst_of(Standing::free);
    return found != nobody ? found : worst_of(Standing::twin);
  }

  /// Takes a particle out and returns its rows of the modes, one a component.
  std::vector<std::vector<double>> take(GlobalIndex particle) {
    const std::size_t columns = modes_.extent(1);
    std::vector<double> values(components_ * columns, 0.0);
    const LocalIndex local = rows_.getLocalElement(particle);
    if (local >= 0 && static_cast<std::size_t>(local) < standing_.size()) {
      standing_[local] = Standing::taken;
      for (int c = 0; c < components_; ++c) {
        for (std::size_t k = 0; k < columns; ++k) values[c * columns + k] = modes_(local * components_ + c, k);
      }
    }
    sum_over_ranks(*rows_.getComm(), values.data(), values.size());
    double size = 0.0;
    for (const double value : values) size += value * value;
    for (std::size_t i = 0; i < standing_.size(); ++i) {
      if (standing_[i] == Standing::free && moves_as(i, values, tie * tie * size)) standing_[i] = Standing::twin;
    }
    std::vector<std::vector<double>> result;
    for (int c = 0; c < components_; ++c) {
      result.emplace_back(values.begin() + c * columns, values.begin() + (c + 1) * columns);
    }
    return result;
  }

 private:
  static constexpr GlobalIndex nobody = std::numeric_limits<GlobalIndex>::max();
  enum class Standing : char { free, twin, taken };

  GlobalIndex worst_of(Standing standing) const {
    double mine = -1.0, largest = -1.0;
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      if (standing_[i] == standing) mine = std::max(mine, errors_[i]);
    }
    Teuchos::reduceAll(*rows_.getComm(), Teuchos::REDUCE_MAX, 1, &mine, &largest);
    GlobalIndex lowest = nobody, particle = nobody;
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      if (standing_[i] != standing || errors_[i] < (1.0 - tie) * largest) continue;
      lowest = std::min(lowest, rows_.getGlobalElement(static_cast<LocalIndex>(i)));
    }
    Teuchos::reduceAll(*rows_.getComm(), Teuchos::REDUCE_MIN, 1, &lowest, &particle);
    return particle;
  }

  /// Whether a particle's rows of the modes are these, but for `most` in the sum of squares.
  bool moves_as(std::size_t particle, const std::vector<double>& values, double most) const {
    const std::size_t columns = modes_.extent(1);
    double difference = 0.0;
    for (std::size_t at = 0; at < values.size() && difference <= most; ++at) {
      const double d = modes_(particle * components_ + at / columns, at % columns) - values[at];
      difference += d * d;
    }
    return difference <= most;
  }

  const Map& rows_;
  ConstMatrixView modes_;
  int components_;
  std::vector<Standing> standing_;
  std::vector<double> errors_;
  VectorView misfit_;
};

/// Part `turn` of `total` things dealt out over `turns`; early turns get one more where they do not divide.
int share(int total, int turns, int turn) { return total / turns + (turn < total % turns ? 1 : 0); }

}  // namespace

Specification Greedy::specification() {
  Specification s;
  s.integer("samples", "particles to choose; left out: samples_per_mode times the residual basis' rank")
      .at_least(1)
      .optional();
  s.real("samples_per_mode",
         "particles a residual mode; 1: interpolation, as the report has it, which amplifies errors")
      .at_least(1)
      .at_most(1000)
      .defaults_to(2.0);
  s.integers("seeds", "ids of particles that are chosen in any case").optional();
  return s;
}

Greedy::Greedy(const Teuchos::ParameterList& list, const NoContext&)
    : path_(list.name()),
      samples_(list.isParameter("samples") ? list.get<int>("samples") : 0),
      samples_per_mode_(list.get<double>("samples_per_mode")) {
  if (!list.isParameter("seeds")) return;
  for (const int seed : list.get<Teuchos::Array<int>>("seeds")) seeds_.push_back(seed);
}

std::vector<GlobalIndex> Greedy::checked_seeds(GlobalIndex particles) const {
  std::vector<Problem> problems;
  std::set<GlobalIndex> known;
  for (std::size_t k = 0; k < seeds_.size(); ++k) {
    const std::string place = fmt::format("{}.seeds.{}", path_, k);
    if (seeds_[k] < 0 || seeds_[k] >= particles) {
      problems.push_back({place,
                          fmt::format("there is no particle {}", seeds_[k]),
                          fmt::format("an id from 0 to {}", particles - 1),
                          {}});
    } else if (!known.insert(seeds_[k]).second) {
      problems.push_back({place, fmt::format("particle {} is named twice", seeds_[k]), "each seed once", {}});
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return seeds_;
}

int Greedy::checked_samples(GlobalIndex particles, int modes, int components, int seeds) const {
  const int fewest = std::max((modes + components - 1) / components, seeds);
  if (samples_ == 0) {
    const int by_modes = static_cast<int>(std::ceil(samples_per_mode_ * modes));
    return static_cast<int>(std::min<GlobalIndex>(std::max(by_modes, fewest), particles));
  }
  if (samples_ < fewest) {
    throw InputError(path_ + ".samples",
                     fmt::format("{} particles with {} component{} each cannot determine {} residual modes{}", samples_,
                                 components, components == 1 ? "" : "s", modes,
                                 seeds > samples_ ? fmt::format(" and hold {} seeds", seeds) : ""),
                     fmt::format("at least {}", fewest));
  }
  if (samples_ > particles) {
    throw InputError(path_ + ".samples", fmt::format("{} particles are asked for", samples_),
                     fmt::format("at most the model's {}", particles));
  }
  return samples_;
}

void Greedy::check(GlobalIndex particles, int components, int residual_modes) const {
  checked_samples(particles, residual_modes, components, static_cast<int>(checked_seeds(particles).size()));
}

std::vector<GlobalIndex> Greedy::sample(const Map& rows, ConstMatrixView modes, int components) const {
  const auto particles = static_cast<GlobalIndex>(rows.getGlobalNumElements());
  std::vector<GlobalIndex> chosen = checked_seeds(particles);
  const int working = static_cast<int>(modes.extent(1));
  const int wanted = checked_samples(particles, working, components, static_cast<int>(chosen.size()));

  Candidates candidates(rows, modes, components);
  GrowingLeastSquares fit(working);
  const auto take = [&](GlobalIndex particle) {
    for (std::vector<double>& row : candidates.take(particle)) fit.add_row(std::move(row));
  };
  for (const GlobalIndex seed : chosen) take(seed);

  const int to_add = wanted - static_cast<int>(chosen.size());
  const int turns = std::min(working, to_add);
  int column = 0;
  for (int turn = 0; turn < turns; ++turn) {
    candidates.clear_errors();
    const int columns = share(working, turns, turn);
    for (int q = column; q < column + columns; ++q) candidates.add_misfit(q, fit.solve(q));
    column += columns;
    for (int k = share(to_add, turns, turn); k > 0; --k) {
      const GlobalIndex particle = candidates.worst();
      take(particle);
      chosen.push_back(particle);
    }
    if (turn + 1 == turns) break;
    while (fit.leading() < column) fit.add_column();
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

KILN_REGISTER(Sampling, Greedy, "greedy", "GNAT's greedy choice of sampled particles (Carlberg et al. 2013, Alg. 3)");

}  // namespace kiln
