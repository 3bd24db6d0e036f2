#include "framework/model/Halo.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_MultiVector.hpp>

#include "framework/model/DegreesOfFreedom.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/framework/model/TestModels.hpp"

namespace kiln {
namespace {

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

TEST(DegreesOfFreedom, ParticlesTimesComponents) {
  const PendulumRing ring(11, world());
  const auto map = degree_of_freedom_map(ring.sources(), 2);
  ASSERT_EQ(local_size(*map), 2 * local_size(*ring.sources()));
  for (LocalIndex i = 0; i < local_size(*map); ++i) {
    EXPECT_EQ(map->getGlobalElement(i), 2 * ring.sources()->getGlobalElement(i / 2) + i % 2);
  }
  EXPECT_EQ(degree_of_freedom_map(ring.rows(), 1), ring.rows()) << "one component needs no other map";
  const auto contiguous = Teuchos::rcp(new Map(12, 0, world()));
  const auto pairs = degree_of_freedom_map(contiguous, 3);
  EXPECT_EQ(pairs->getGlobalNumElements(), 36u);
  EXPECT_EQ(pairs->getMinGlobalIndex(), 3 * contiguous->getMinGlobalIndex());
}

TEST(Halo, FillsTheSourcesFromTheirOwners) {
  const PendulumRing ring(11, world());
  const Halo halo(ring);
  Halo::State state(halo);
  for (int seed = 0; seed < 3; ++seed) {
    const VectorView expected = contract::pattern_over_sources(ring, 1.0, seed);
    Kokkos::deep_copy(state.sources(), std::nan(""));
    Kokkos::deep_copy(state.rows(), Kokkos::subview(expected, std::make_pair(LocalIndex(0), halo.row_size())));
    state.fill();
    for (LocalIndex i = 0; i < halo.source_size(); ++i) EXPECT_EQ(state.sources()(i), expected(i));
  }
}

TEST(Halo, BringsMultivectors) {
  const DiffusionChain chain({}, world());
  const Halo halo(chain);
  MultiVector rows(halo.rows(), 3), sources(halo.sources(), 3);
  for (int k = 0; k < 3; ++k) {
    for (LocalIndex i = 0; i < halo.row_size(); ++i) {
      rows.replaceLocalValue(i, k, contract::pattern(halo.rows()->getGlobalElement(i), 0, k));
    }
  }
  halo.bring(rows, sources);
  for (int k = 0; k < 3; ++k) {
    const auto values = sources.getData(k);
    for (LocalIndex i = 0; i < halo.source_size(); ++i) {
      EXPECT_EQ(values[i], contract::pattern(halo.sources()->getGlobalElement(i), 0, k));
    }
  }
}

}  // namespace
}  // namespace kiln
