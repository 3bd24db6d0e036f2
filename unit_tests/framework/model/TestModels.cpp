#include "unit_tests/framework/model/TestModels.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>

#include "framework/model/ParticleMap.hpp"

namespace kiln {
namespace {

KILN_REGISTER(Model, RationalDecay, "test rational decay", "one particle with a closed form");
KILN_REGISTER(Model, DiffusionChain, "test diffusion chain", "a line of particles, all Jacobian forms");
KILN_REGISTER(Model, PendulumRing, "test pendulum ring", "two components, rate alone");

/// Blocks of uneven length: rank 0 has the most.
std::vector<GlobalIndex> block(GlobalIndex particles, const Communicator& comm) {
  const GlobalIndex ranks = comm.getSize(), rank = comm.getRank();
  const auto start = [&](GlobalIndex r) { return particles - particles * (ranks - r) * (ranks - r) / (ranks * ranks); };
  std::vector<GlobalIndex> ids;
  for (GlobalIndex i = start(rank); i < start(rank + 1); ++i) ids.push_back(i);
  return ids;
}

/// `rows`, then those of `wanted` that are not among them, each once.
Teuchos::RCP<const Map> sources_of(std::vector<GlobalIndex> rows, const std::vector<GlobalIndex>& wanted,
                                   const Teuchos::RCP<const Communicator>& comm) {
  for (GlobalIndex id : wanted) {
    if (std::find(rows.begin(), rows.end(), id) == rows.end()) rows.push_back(id);
  }
  return map_of(rows, comm);
}

}  // namespace

Specification RationalDecay::specification() { return {}; }

RationalDecay::RationalDecay(const Teuchos::ParameterList&, const Context& context)
    : RationalDecay(context.communicator) {}

RationalDecay::RationalDecay(const Teuchos::RCP<const Communicator>& communicator)
    : map_(map_of(communicator->getRank() == 0 ? std::vector<GlobalIndex>{0} : std::vector<GlobalIndex>{},
                  communicator)) {
  parameters_.add("strength", "1", &strength_);
}

double RationalDecay::solution(double time) const { return 1.0 / (1.0 + strength_ * time * time); }

void RationalDecay::initial_state(VectorView u) const { Kokkos::deep_copy(u, 1.0); }

void RationalDecay::rate(ConstVectorView u, double time, VectorView f) const {
  for (std::size_t i = 0; i < f.extent(0); ++i) f(i) = -2.0 * strength_ * time * u(i) * u(i);
}

void RationalDecay::rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const {
  for (std::size_t i = 0; i < diagonal.extent(0); ++i) diagonal(i) = -4.0 * strength_ * time * u(i);
}

Specification DiffusionChain::specification() {
  const Settings defaults;
  Specification s;
  s.integer("particles", "length of the line").at_least(2).defaults_to(defaults.particles);
  s.real("conduction", "rate of exchange between neighbours").unit("1/s").defaults_to(defaults.conduction);
  s.real("reaction", "strength of the cubic sink").unit("1/(K^2 s)").defaults_to(defaults.reaction);
  return s;
}

DiffusionChain::DiffusionChain(const Teuchos::ParameterList& list, const Context& context)
    : DiffusionChain({list.get<int>("particles"), list.get<double>("conduction"), list.get<double>("reaction")},
                     context.communicator) {}

DiffusionChain::DiffusionChain(const Settings& settings, const Teuchos::RCP<const Communicator>& communicator)
    : settings_(settings) {
  const auto ids = block(settings.particles, *communicator);
  rows_ = map_of(ids, communicator);
  domain_ = rows_;
  set_rows(ids);
}

DiffusionChain::DiffusionChain(const DiffusionChain& full, const std::vector<GlobalIndex>& rows)
    : settings_(full.settings_), domain_(full.domain_) {
  std::vector<GlobalIndex> mine;
  for (GlobalIndex row : rows) {
    if (full.rows_->isNodeGlobalElement(row)) mine.push_back(row);
  }
  std::sort(mine.begin(), mine.end());
  rows_ = map_of(mine, full.rows_->getComm());
  set_rows(mine);
}

void DiffusionChain::set_rows(const std::vector<GlobalIndex>& rows) {
  parameters_.add("conduction", "1/s", &settings_.conduction);
  parameters_.add("reaction", "1/(K^2 s)", &settings_.reaction);
  const auto inside = [&](GlobalIndex i) { return std::clamp<GlobalIndex>(i, 0, settings_.particles - 1); };
  std::vector<GlobalIndex> wanted;
  for (GlobalIndex i : rows) wanted.insert(wanted.end(), {inside(i - 1), inside(i + 1)});
  sources_ = sources_of(rows, wanted, rows_->getComm());
  for (GlobalIndex i : rows) {
    left_.push_back(sources_->getLocalElement(inside(i - 1)));
    right_.push_back(sources_->getLocalElement(inside(i + 1)));
  }
  positions_ = PositionView("kiln::test::positions", local_size(*sources_));
  for (LocalIndex i = 0; i < local_size(*sources_); ++i) positions_(i, 0) = 0.5 * sources_->getGlobalElement(i);
}

void DiffusionChain::initial_state(VectorView u) const {
  for (LocalIndex i = 0; i < local_size(*sources_); ++i) u(i) = 1.0 + std::cos(0.7 * sources_->getGlobalElement(i));
}

void DiffusionChain::rate(ConstVectorView u, double time, VectorView f) const {
  for (LocalIndex i = 0; i < local_size(*rows_); ++i) {
    const double heat = rows_->getGlobalElement(i) % 5 == 0 ? 3.0 : 0.1;
    f(i) = settings_.conduction * (u(left_[i]) - 2.0 * u(i) + u(right_[i])) - settings_.reaction * u(i) * u(i) * u(i) +
           heat * (1.0 + std::sin(3.0 * time));
  }
}

void DiffusionChain::rate_jacobian_diagonal(ConstVectorView u, double, VectorView diagonal) const {
  for (LocalIndex i = 0; i < local_size(*rows_); ++i) {
    const int neighbours = (left_[i] != i) + (right_[i] != i);
    diagonal(i) = -neighbours * settings_.conduction - 3.0 * settings_.reaction * u(i) * u(i);
  }
}

void DiffusionChain::apply_rate_jacobian(ConstVectorView u, double, ConstMatrixView v, MatrixView product) const {
  for (std::size_t k = 0; k < v.extent(1); ++k) {
    for (LocalIndex i = 0; i < local_size(*rows_); ++i) {
      product(i, k) = settings_.conduction * (v(left_[i], k) - 2.0 * v(i, k) + v(right_[i], k)) -
                      3.0 * settings_.reaction * u(i) * u(i) * v(i, k);
    }
  }
}

Teuchos::RCP<const CrsMatrix> DiffusionChain::rate_jacobian_matrix(ConstVectorView u, double time) const {
  const VectorView diagonal("kiln::test::diagonal", local_size(*rows_));
  rate_jacobian_diagonal(u, time, diagonal);
  const bool first = matrix_.is_null();
  if (first) {
    matrix_ = Teuchos::rcp(new CrsMatrix(rows_, sources_, 3));
  } else {
    matrix_->resumeFill();
  }
  for (LocalIndex i = 0; i < local_size(*rows_); ++i) {
    std::vector<LocalIndex> columns{i};
    std::vector<double> values{diagonal(i)};
    for (LocalIndex j : {left_[i], right_[i]}) {
      if (j == i) continue;
      columns.push_back(j);
      values.push_back(settings_.conduction);
    }
    const auto count = static_cast<LocalIndex>(columns.size());
    if (first) {
      matrix_->insertLocalValues(i, count, values.data(), columns.data());
    } else {
      matrix_->replaceLocalValues(i, count, values.data(), columns.data());
    }
  }
  matrix_->fillComplete(domain_, rows_);
  return matrix_;
}

std::unique_ptr<Model> DiffusionChain::sampled(const std::vector<GlobalIndex>& rows) const {
  return std::unique_ptr<Model>(new DiffusionChain(*this, rows));
}

Specification PendulumRing::specification() {
  Specification s;
  s.integer("particles", "pendulums in the ring").at_least(3).defaults_to(11);
  return s;
}

PendulumRing::PendulumRing(const Teuchos::ParameterList& list, const Context& context)
    : PendulumRing(list.get<int>("particles"), context.communicator) {}

PendulumRing::PendulumRing(int particles, const Teuchos::RCP<const Communicator>& communicator)
    : particles_(particles) {
  parameters_.add("gravity", "1/s^2", &gravity_);
  parameters_.add("coupling", "1/s^2", &coupling_);
  const auto rows = block(particles, *communicator);
  const auto inside = [&](GlobalIndex i) { return (i + particles_) % particles_; };
  std::vector<GlobalIndex> wanted;
  for (GlobalIndex i : rows) wanted.insert(wanted.end(), {inside(i - 1), inside(i + 1)});
  rows_ = map_of(rows, communicator);
  sources_ = sources_of(rows, wanted, communicator);
  for (GlobalIndex i : rows) {
    left_.push_back(sources_->getLocalElement(inside(i - 1)));
    right_.push_back(sources_->getLocalElement(inside(i + 1)));
  }
}

void PendulumRing::initial_state(VectorView u) const {
  for (LocalIndex i = 0; i < local_size(*sources_); ++i) {
    u(2 * i) = std::sin(1.0 + sources_->getGlobalElement(i));
    u(2 * i + 1) = 0.3 * std::cos(2.0 * sources_->getGlobalElement(i));
  }
}

void PendulumRing::rate(ConstVectorView u, double, VectorView f) const {
  for (LocalIndex i = 0; i < local_size(*rows_); ++i) {
    f(2 * i) = u(2 * i + 1);
    f(2 * i + 1) = -gravity_ * std::sin(u(2 * i)) + coupling_ * (u(2 * left_[i]) - 2.0 * u(2 * i) + u(2 * right_[i]));
  }
}

}  // namespace kiln
