#include <gtest/gtest.h>

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Map.hpp>
#include <cmath>
#include <random>

#include "Chain.hpp"
#include "framework/base/Error.hpp"
#include "rom/sampling/GappyOperator.hpp"
#include "rom/sampling/Greedy.hpp"
#include "rom/sampling/GrowingLeastSquares.hpp"

namespace kiln {
namespace {

using test::self;
using test::world;
using Ids = std::vector<GlobalIndex>;
using Table = std::vector<std::vector<double>>;  ///< one row an entry of particles × components

std::unique_ptr<Sampling> greedy(int samples, const std::vector<int>& seeds = {}, double samples_per_mode = 2.0) {
  Teuchos::ParameterList list("reduction.sampling");
  list.set("type", std::string("greedy"));
  if (samples > 0) list.set("samples", samples);
  list.set("samples_per_mode", samples_per_mode);
  if (!seeds.empty()) list.set("seeds", Teuchos::Array<int>(seeds));
  return Registry<Sampling>::create(list, NoContext{});
}

/// Samples rows of a table known everywhere, spread over the ranks.
Ids sample(const Sampling& sampling, const Table& table, int components, const Teuchos::RCP<const Communicator>& comm) {
  const Map map(table.size() / components, 0, comm);
  const std::size_t particles = local_size(map);
  MatrixView modes("modes", particles * components, table.front().size());
  for (std::size_t i = 0; i < particles; ++i) {
    for (int c = 0; c < components; ++c) {
      for (std::size_t k = 0; k < table.front().size(); ++k) {
        modes(i * components + c, k) = table[map.getGlobalElement(static_cast<LocalIndex>(i)) * components + c][k];
      }
    }
  }
  return sampling.sample(map, modes, components);
}

Table random_table(int rows, int columns) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  Table table(rows, std::vector<double>(columns));
  for (auto& row : table) {
    for (double& value : row) value = normal(generator);
  }
  return table;
}

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

// Worked by hand. Turn 1 adds two particles by the first mode's squares: 3 (25), then 0 (16). Turn 2 fits the second
// mode at {3, 0} by the first: α = (5·1 + 4·2)/(25 + 16) = 13/41; misfits 2 − 52/41 = 0.73, 0 − 13/41 = −0.32, 4 −
// 26/41 = 3.37, 1 − 65/41 = −0.59, 1 − 39/41 = 0.05: particle 2 is worst.
const Table by_hand{{4, 2}, {1, 0}, {2, 4}, {5, 1}, {3, 1}};

TEST(Greedy, ChoosesAsWorkedByHand) {
  EXPECT_EQ(sample(*greedy(3), by_hand, 1, world()), (Ids{0, 2, 3}));
  EXPECT_EQ(sample(*greedy(2), by_hand, 1, world()), (Ids{2, 3}));  // α = 1/5 at {3}: misfits 1.2, −0.2, 3.6, 0, 0.4
  // Two a turn: turn 2 adds 2 and, by the same misfits, 0.73 at 0 being taken already, −0.59 at 3 too, then 1 (−0.32).
  EXPECT_EQ(sample(*greedy(4), by_hand, 1, world()), (Ids{0, 1, 2, 3}));
}

TEST(Greedy, KeepsItsSeeds) {
  // One particle more beside the seed: both modes enter in one turn, whose errors are 20, 1, 20, 26, 10; 3 is worst.
  EXPECT_EQ(sample(*greedy(2, {1}), by_hand, 1, world()), (Ids{1, 3}));
  EXPECT_EQ(sample(*greedy(2, {4, 1}), by_hand, 1, world()), (Ids{1, 4}));
}

TEST(Greedy, TakesTheLowestIdOfTies) {
  // Mirror images, with round-off between them.
  Table table = {{1, 0}, {2, 1}, {3, 5}, {3 * (1 + 1e-12), 5}, {2, 1}, {1, 0}};
  // Then α = 5/3 at {2}: misfits −1.67, −2.33, 0, 0, −2.33, −1.67.
  EXPECT_EQ(sample(*greedy(2), table, 1, world()), (Ids{1, 2}));
}

TEST(Greedy, LeavesTwinsForTheEnd) {
  // Three pairs of mirror images. Turn 1 adds 1 (9) and, since 2 tells nothing new, 0 (4). Turn 2 has α = 17/13 at
  // {1, 0}: of the particles that are nobody's twin only 4 and 5 are left, misfit −1.31, and then only twins: 1.08,
  // −1.62, −1.31.
  const Table table = {{2, 1}, {3, 5}, {3, 5}, {2, 1}, {1, 0}, {1, 0}};
  EXPECT_EQ(sample(*greedy(4), table, 1, world()), (Ids{0, 1, 3, 4}));
  EXPECT_EQ(sample(*greedy(6), table, 1, world()).size(), 6u);
}

TEST(Greedy, AddsUpAParticlesComponents) {
  // Squares of the first mode by particle: 25 + 0, 16 + 16, 1 + 1.
  const Table table = {{5}, {0}, {4}, {4}, {1}, {1}};
  EXPECT_EQ(sample(*greedy(1), table, 2, world()), (Ids{1}));
}

TEST(Greedy, ChoosesAsManyAModeAsAsked) {
  const Table table = random_table(90, 12);
  EXPECT_EQ(sample(*greedy(0, {}, 1.0), table, 1, world()).size(), 12u);
  EXPECT_EQ(sample(*greedy(0, {}, 1.3), table, 1, world()).size(), 16u);
}

TEST(Greedy, ChoosesTheSameOnAnyNumberOfRanks) {
  for (const int components : {1, 2}) {
    const Table table = random_table(90 * components, 12);
    for (const int samples : {0, 12, 17, 40}) {
      const Ids together = sample(*greedy(samples, {5, 80}), table, components, world());
      EXPECT_EQ(together, sample(*greedy(samples, {5, 80}), table, components, self()));
      EXPECT_EQ(together.size(), samples == 0 ? 24u : static_cast<std::size_t>(samples));
      EXPECT_TRUE(std::binary_search(together.begin(), together.end(), 5));
      EXPECT_TRUE(std::adjacent_find(together.begin(), together.end(), std::greater_equal<GlobalIndex>()) ==
                  together.end());
    }
  }
}

TEST(Greedy, RefusesWhatCannotBe) {
  const Table table = random_table(20, 6);
  EXPECT_NO_THROW(greedy(6)->check(20, 1, 6));
  EXPECT_NO_THROW(greedy(1)->check(20, 1, 0)) << "where the snapshots decide";
  EXPECT_EQ(message([&] { greedy(5)->check(20, 1, 6); }), message([&] { sample(*greedy(5), table, 1, world()); }));
  EXPECT_EQ(
      message([&] { sample(*greedy(5), table, 1, world()); }),
      "reduction.sampling.samples: 5 particles with 1 component each cannot determine 6 residual modes; expected at "
      "least 6");
  EXPECT_EQ(
      message([&] { sample(*greedy(2), table, 2, world()); }),
      "reduction.sampling.samples: 2 particles with 2 components each cannot determine 6 residual modes; expected "
      "at least 3");
  EXPECT_EQ(message([&] { sample(*greedy(21), table, 1, world()); }),
            "reduction.sampling.samples: 21 particles are asked for; expected at most the model's 20");
  EXPECT_EQ(message([&] {
              sample(*greedy(8, {3, 20, 3}), table, 1, world());
            }),
            "reduction.sampling.seeds.1: there is no particle 20; expected an id from 0 to 19\n"
            "reduction.sampling.seeds.2: particle 3 is named twice; expected each seed once");
}

TEST(GrowingLeastSquares, AgreesWithNormalEquationsAsItGrows) {
  const Table rows = random_table(12, 5);
  GrowingLeastSquares fit(5);
  std::size_t used = 0;
  for (int b = 1; b <= 4; ++b) {
    for (int k = 0; k < 3; ++k) fit.add_row(rows[used++]);
    fit.add_column();
    const std::vector<double> alpha = fit.solve(4);
    // The misfit is orthogonal to every column of the leading block.
    for (int j = 0; j < b; ++j) {
      double product = 0.0;
      for (std::size_t i = 0; i < used; ++i) {
        double misfit = -rows[i][4];
        for (int k = 0; k < b; ++k) misfit += rows[i][k] * alpha[k];
        product += misfit * rows[i][j];
      }
      EXPECT_NEAR(product, 0.0, 1e-12) << b << " columns";
    }
  }
}

TEST(GappyOperator, IsALeftInverse) {
  const Table table = random_table(9, 4);
  MatrixView modes("P Phi_r", 9, 4);
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < 4; ++k) modes(i, k) = table[i][k];
  }
  const GappyOperator gappy = gappy_operator(modes, "reduction.sampling");
  MatrixView identity("A P Phi_r", 4, 4);
  dense::product(dense::Transpose::no, dense::Transpose::no, 1.0, gappy.matrix, modes, 0.0, identity);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(identity(i, j), i == j ? 1.0 : 0.0, 1e-14);
  }
  const std::vector<double> sigma = dense::svd(modes).values;
  EXPECT_NEAR(gappy.smallest_singular_value, sigma.back(), 1e-15);
  EXPECT_NEAR(gappy.condition, sigma.front() / sigma.back(), 1e-12);
}

TEST(GappyOperator, RefusesDependentRows) {
  MatrixView modes("P Phi_r", 3, 2);
  for (int i = 0; i < 3; ++i) modes(i, 0) = modes(i, 1) = i + 1.0;
  EXPECT_NE(message([&] {
              gappy_operator(modes, "reduction.sampling");
            }).find("reduction.sampling: the sampled particles cannot tell the residual modes apart"),
            std::string::npos);
}

}  // namespace
}  // namespace kiln
