#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/os.h>

#include <Teuchos_CommHelpers.hpp>
#include <functional>
#include <random>

#include "physics/sph/PairLayout.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

double over_ranks(double value, Teuchos::EReductionType reduction) {
  double result = 0.0;
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), reduction, 1, &value, &result);
  return result;
}

ThermalStateView rough_states(const HeatModel& model) {
  const VectorView u = rough_state(model);
  ThermalStateView states("states", u.extent(0) + 1);
  for (std::size_t j = 0; j < u.extent(0); ++j) {
    states(j) = thermal_state(model.material(), u(j), model.domain().masses(j));
  }
  states(u.extent(0)) = nobody;
  return states;
}

/// Σ_j of Eq. 11's sum (without 4 V_i), or of its derivative with the properties held, as printed: with conductivities,
/// pair by pair.
VectorView plain_sum(PairQuantity quantity, const HeatDomain& domain, const ThermalStateView& states) {
  VectorView sums("sums", domain.areas.extent(0));
  for (std::size_t i = 0; i < sums.extent(0); ++i) {
    const double k_i = 1.0 / states(i).resistivity;
    for (std::size_t pair = domain.pairs.offsets(i); pair < domain.pairs.offsets(i + 1); ++pair) {
      const ThermalState<double>& j = states(domain.pairs.neighbours(pair));
      const double k_j = 1.0 / j.resistivity;
      const double difference = quantity == PairQuantity::flux ? states(i).temperature - j.temperature : 1.0;
      sums(i) += j.volume * k_i * k_j / (k_i + k_j) * difference * domain.weights(pair);
    }
  }
  return sums;
}

/// Largest difference relative to the largest expected value, over all ranks.
double difference(const VectorView& found, const VectorView& expected) {
  double most = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < found.extent(0); ++i) {
    const double off = std::abs(found(i) - expected(i));
    most = std::isnan(off) ? INFINITY : std::max(most, off);
    scale = std::max(scale, std::abs(expected(i)));
  }
  return over_ranks(most, Teuchos::REDUCE_MAX) / over_ranks(scale, Teuchos::REDUCE_MAX);
}

/// |Σ_i V_i sum_i| over Σ_i V_i |sum_i|: what the pairs exchange must cancel.
double lost(const VectorView& fluxes, const ThermalStateView& states) {
  double sum = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < fluxes.extent(0); ++i) {
    sum += states(i).volume * fluxes(i);
    all += states(i).volume * std::abs(fluxes(i));
  }
  return std::abs(over_ranks(sum, Teuchos::REDUCE_SUM)) / over_ranks(all, Teuchos::REDUCE_SUM);
}

void expect_plain_sums(const PairLayout* layout, const HeatModel& model, const std::string& what) {
  if (layout == nullptr) return;
  SCOPED_TRACE(what + ", " + layout->name());
  const ThermalStateView states = rough_states(model);
  VectorView sums("sums", model.domain().areas.extent(0));
  for (const PairQuantity quantity : {PairQuantity::flux, PairQuantity::conductance}) {
    // Rubbish of an earlier sum must not stay.
    Kokkos::deep_copy(sums, 1e30);
    layout->sum(quantity, states, sums);
    layout->sum(quantity, states, sums);
    EXPECT_LE(difference(sums, plain_sum(quantity, model.domain(), states)), 1e-12);
  }
  layout->sum(PairQuantity::flux, states, sums);
  EXPECT_LE(lost(sums, states), 1e-13);
}

/// Whether a lattice's sweep was among the layouts.
bool expect_plain_sums(const HeatModel& model, const std::string& what) {
  // Layouts may differ from rank to rank, comparisons are of all ranks together.
  const auto listed = sliced_rows(model.domain());
  expect_plain_sums(listed.get(), model, what);
  const auto half = half_list(model.domain());
  expect_plain_sums(half.get(), model, what);
  const auto lattice = lattice_sweep(model.domain());
  const bool everywhere = over_ranks(lattice ? 1.0 : 0.0, Teuchos::REDUCE_MIN) == 1.0;
  if (everywhere) expect_plain_sums(lattice.get(), model, what);
  return everywhere;
}

std::string place(const HeatCase& c) {
  return fmt::format("{} x {} x {} {}, {}, {}", c.count[0], c.count[1], c.count[2], c.placement, c.boundary, c.kernel);
}

/// A case whose particles come from a file: those of a 12 x 9 x 6 lattice that `keep` keeps, moved by `move`.
Teuchos::ParameterList from_file(const std::string& file, const std::function<bool(int)>& keep,
                                 const std::function<double()>& move) {
  HeatCase heat_case;
  heat_case.heat_source = HeatCase::no_source();
  Teuchos::ParameterList list = heat_case.list();
  const auto communicator = Tpetra::getDefaultComm();
  if (communicator->getRank() == 0) {
    auto csv = fmt::output_file(file);
    csv.print("x,y,z\n");
    for (int id = 0; id < 12 * 9 * 6; ++id) {
      if (!keep(id)) continue;
      csv.print("{:.17g},{:.17g},{:.17g}\n", 40e-6 * (id % 12) + move(), 41e-6 * (id / 12 % 9) + move(),
                39e-6 * (id / 108) + move());
    }
  }
  communicator->barrier();
  list.remove("particles");
  Teuchos::ParameterList& particles = list.sublist("particles").setName("model.particles");
  particles.set("type", std::string("file")).set("path", file).set("spacing", 41e-6).set("volume", 4e-11);
  return list;
}

HeatModel model_of(const Teuchos::ParameterList& list) { return {list, Model::Context{Tpetra::getDefaultComm()}}; }

/// Then a rank may have no row, and no lattice.
bool several_ranks() { return Tpetra::getDefaultComm()->getSize() > 1; }

double at_rest() { return 0.0; }

TEST(PairLayout, LatticesOfEveryShapeSumAsThePlainLoop) {
  for (const std::array<int, 3> count : {std::array{12, 9, 6}, std::array{30, 2, 2}, std::array{2, 3, 25},
                                         std::array{3, 40, 2}, std::array{2, 2, 2}, std::array{17, 16, 3}}) {
    HeatCase nodes;
    nodes.count = count;
    nodes.size = {40e-6 * (count[0] - 1), 41e-6 * (count[1] - 1), 30e-6 * (count[2] - 1)};
    EXPECT_TRUE(expect_plain_sums(*nodes.model(), place(nodes)) || several_ranks()) << place(nodes);
    HeatCase cells = nodes;
    cells.placement = "cells";
    cells.kernel = "wendland c2";
    EXPECT_TRUE(expect_plain_sums(*cells.model(), place(cells)) || several_ranks()) << place(cells);
    cells.boundary = "mirrored";
    EXPECT_TRUE(expect_plain_sums(*cells.model(), place(cells)) || several_ranks()) << place(cells);
  }
}

TEST(PairLayout, SheetsAndRodsOfOneLayerSumAsThePlainLoop) {
  for (const std::array<int, 3> count : {std::array{14, 11, 1}, std::array{1, 1, 23}, std::array{1, 9, 7}}) {
    for (const char* boundary : {"as printed", "mirrored"}) {
      HeatCase cells;
      cells.placement = "cells";
      cells.count = count;
      cells.size = {40e-6 * count[0], 40e-6 * count[1], 40e-6 * count[2]};
      cells.boundary = boundary;
      EXPECT_TRUE(expect_plain_sums(*cells.model(), place(cells)) || several_ranks()) << place(cells);
    }
  }
}

TEST(PairLayout, ACutLatticeIsALattice) {
  const TestFolder folder;
  const auto keep = [](int id) { return id % 7 != 3 && (id < 300 || id > 330); };
  const HeatModel model = model_of(from_file(folder / "cut.csv", keep, at_rest));
  ASSERT_TRUE(model.domain().stencil);
  EXPECT_STREQ(model.layout().name(), "lattice sweep");
  expect_plain_sums(model, "cut lattice");
}

TEST(PairLayout, AJitteredCloudSumsAsThePlainLoop) {
  const TestFolder folder;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> jitter(-8e-6, 8e-6);
  const HeatModel model = model_of(from_file(
      folder / "cloud.csv", [](int) { return true; }, [&] { return jitter(generator); }));
  EXPECT_FALSE(model.domain().stencil);
  EXPECT_EQ(lattice_sweep(model.domain()), nullptr);
  expect_plain_sums(model, "jittered cloud");
  if (model.rows()->getComm()->getSize() == 1) {
    EXPECT_STREQ(model.layout().name(), "half list");
  }
}

TEST(PairLayout, OneParticleOffItsPlaceIsNoLattice) {
  const TestFolder folder;
  int coordinate = 0;
  const auto nudge = [&coordinate] { return ++coordinate == 901 ? 1e-12 : 0.0; };
  const HeatModel model = model_of(from_file(
      folder / "nudged.csv", [](int) { return true; }, nudge));
  EXPECT_FALSE(model.domain().stencil);
}

TEST(PairLayout, AStencilThatDiffersFromThePairsIsRefused) {
  const auto model = HeatCase().model(alone());
  EXPECT_NE(lattice_sweep(model->domain()), nullptr);
  HeatDomain heavier = model->domain();
  heavier.weights = VectorView("weights", heavier.weights.extent(0));
  Kokkos::deep_copy(heavier.weights, model->domain().weights);
  heavier.weights(12345) *= 1.0 + 1e-6;
  EXPECT_EQ(lattice_sweep(heavier), nullptr);
  HeatDomain missing = model->domain();
  LatticeStencil stencil = *missing.stencil;
  stencil.offsets.resize(stencil.offsets.size() - 2);
  stencil.weights.resize(stencil.offsets.size());
  missing.stencil = stencil;
  EXPECT_EQ(lattice_sweep(missing), nullptr);
  HeatDomain more = model->domain();
  stencil = *more.stencil;
  stencil.offsets.insert(stencil.offsets.end(), {{3, 3, 0}, {-3, -3, 0}});
  stencil.weights.insert(stencil.weights.end(), {stencil.weights[0], stencil.weights[0]});
  more.stencil = stencil;
  EXPECT_EQ(lattice_sweep(more), nullptr);
}

TEST(PairLayout, IsChosenFromTheParticles) {
  const auto model = HeatCase().model(alone());
  EXPECT_STREQ(model->layout().name(), "lattice sweep");
  const auto sample = model->sampled({5, 100, 200, 333});
  EXPECT_STREQ(dynamic_cast<const HeatModel&>(*sample).layout().name(), "sliced rows");
}

/// Neither on how many they are nor on how many pairs they have: the same bits on any number of ranks.
TEST(PairLayout, ARowsSumDoesNotDependOnTheRowsBesideIt) {
  const auto whole = HeatCase().model(alone());
  const std::vector<GlobalIndex> rows = {0, 5, 11, 100, 200, 333, 340, 500, 501, 640, 647};
  const auto rates_of = [&](const std::vector<GlobalIndex>& chosen) {
    const auto sample = whole->sampled(chosen);
    const VectorView u("u", sample->sources()->getNodeNumElements()), f("f", chosen.size());
    for (std::size_t j = 0; j < u.extent(0); ++j) {
      u(j) = rough_temperature(sample->sources()->getGlobalElement(static_cast<LocalIndex>(j)));
    }
    sample->rate(u, 1e-4, f);
    return f;
  };
  const VectorView together = rates_of(rows);
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(rates_of({rows[i]})(0), together(i)) << "particle " << rows[i];
}

/// Off by one place in the arrays shows up in the neighbours of a single hot particle.
TEST(PairLayout, OneHotParticleWarmsItsNeighboursOnly) {
  const auto model = HeatCase().model(alone());
  const HeatDomain& domain = model->domain();
  for (const LocalIndex hot : {0, 11, 107, 300, 647}) {
    VectorView u("u", domain.masses.extent(0));
    Kokkos::deep_copy(u, 300.0);
    u(hot) = 1000.0;
    const VectorView f = rate_of(*model, u, -1.0);
    std::vector<bool> warms(f.extent(0), false);
    for (std::size_t pair = domain.pairs.offsets(hot); pair < domain.pairs.offsets(hot + 1); ++pair) {
      warms[domain.pairs.neighbours(pair)] = true;
    }
    for (LocalIndex i = 0; i < static_cast<LocalIndex>(f.extent(0)); ++i) {
      if (i == hot) {
        EXPECT_LT(f(i), 0.0);
      } else {
        EXPECT_EQ(f(i) > 0.0, warms[i]) << "hot " << hot << ", row " << i;
      }
    }
  }
}

}  // namespace
}  // namespace kiln
