#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <fstream>
#include <new>
#include <numeric>

#include "Chain.hpp"
#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/pod/Tsqr.hpp"

namespace kiln {
namespace {

using dense::Transpose;
using test::self;
using test::world;

/// Entry (i, k) of the orthonormal cosine basis of n points.
double cosine(int i, int k, int n) { return std::sqrt((k == 0 ? 1.0 : 2.0) / n) * std::cos(M_PI * (i + 0.5) * k / n); }

/// Snapshots with known factors: A = Σ_k sigma_k u_k v_kᵀ, u and v cosines. Rank r holds rows first(r) … first(r + 1)
/// − 1.
struct Known {
  int rows, columns;
  std::vector<double> sigma;

  int first(const Communicator& communicator, int rank) const {
    // Uneven on purpose; the first of three ranks has none.
    const int ranks = communicator.getSize();
    if (ranks == 1) return rank == 0 ? 0 : rows;
    const double share = static_cast<double>(rank) / ranks;
    return rank == ranks ? rows : ranks == 3 && rank == 1 ? 0 : static_cast<int>(rows * share * share);
  }
  Snapshots snapshots(const Communicator& communicator) const {
    const int begin = first(communicator, communicator.getRank()),
              end = first(communicator, communicator.getRank() + 1);
    Snapshots result(end - begin);
    VectorView column("column", end - begin);
    for (int j = 0; j < columns; ++j) {
      for (int i = begin; i < end; ++i) {
        column(i - begin) = 0.0;
        for (std::size_t k = 0; k < sigma.size(); ++k) {
          column(i - begin) +=
              sigma[k] * cosine(i, static_cast<int>(k) + 1, rows) * cosine(j, static_cast<int>(k), columns);
        }
      }
      result.append(column);
    }
    return result;
  }
};

PodSettings settings(const std::string& algorithm, int rank) {
  PodSettings result;
  result.path = "reduction.basis";
  result.algorithm = algorithm == "tsqr"         ? PodSettings::Algorithm::tsqr
                     : algorithm == "randomised" ? PodSettings::Algorithm::randomised
                                                 : PodSettings::Algorithm::gram;
  result.rank = rank;
  return result;
}

MatrixView products(const MatrixView& a, const MatrixView& b, const Communicator& communicator) {
  MatrixView c("products", a.extent(1), b.extent(1));
  dense::product(Transpose::yes, Transpose::no, 1.0, a, b, 0.0, c);
  sum_over_ranks(communicator, c.data(), c.size());
  return c;
}

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

class PodOf : public testing::TestWithParam<const char*> {};

TEST_P(PodOf, RecoversKnownSingularVectors) {
  const Known known{200, 12, {50.0, 20.0, 3.0, 0.4, 1e-3}};
  const Pod result = pod(known.snapshots(*world()), settings(GetParam(), 5), *world());
  ASSERT_EQ(result.modes.extent(1), 5u);
  for (int k = 0; k < 5; ++k) {
    const double accuracy = std::string(GetParam()) != "gram" ? 1e-13 : 1e-15 * std::pow(50.0 / known.sigma[k], 2);
    EXPECT_NEAR(result.singular_values[k], known.sigma[k], 50.0 * 1e-14 + 50.0 * accuracy) << k;
    const int begin = known.first(*world(), world()->getRank());
    // The sign follows the right singular vector, whose largest entry, the first, is positive for cosines.
    for (std::size_t i = 0; i < result.modes.extent(0); ++i) {
      EXPECT_NEAR(result.modes(i, k), cosine(begin + static_cast<int>(i), k + 1, 200),
                  std::string(GetParam()) != "gram" ? 1e-10 : 1e-5 * 1e-3 / std::min(known.sigma[k], 1.0) + 1e-12);
    }
  }
}

TEST_P(PodOf, IsASingularValueDecomposition) {
  const Known known{150, 9, {9.0, 8.0, 5.0, 2.0, 1.0, 0.5, 0.25}};
  const Snapshots snapshots = known.snapshots(*world());
  const Snapshots original = known.snapshots(*world());
  const Pod result = pod(snapshots, settings(GetParam(), 7), *world());
  const MatrixView identity = products(result.modes, result.modes, *world());
  const MatrixView rest = products(result.modes, original.matrix(), *world());  // Φᵀ A = Σ Vᵀ
  MatrixView squares("squares", 7, 7);
  dense::product(Transpose::no, Transpose::yes, 1.0, rest, rest, 0.0, squares);
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 7; ++i) {
      EXPECT_NEAR(identity(i, j), i == j ? 1.0 : 0.0, 1e-12);
      EXPECT_NEAR(squares(i, j), i == j ? known.sigma[i] * known.sigma[i] : 0.0, 1e-11);
    }
  }
  // A = Φ (Φᵀ A).
  MatrixView again("A", original.rows(), 9);
  dense::product(Transpose::no, Transpose::no, 1.0, result.modes, rest, 0.0, again);
  for (std::size_t j = 0; j < 9; ++j) {
    for (std::size_t i = 0; i < original.rows(); ++i) EXPECT_NEAR(again(i, j), original.matrix()(i, j), 1e-12);
  }
  EXPECT_LT(result.orthogonality, 1e-12);
  EXPECT_EQ(result.truncation.independent, 7);
}

TEST_P(PodOf, IsTheSameOnAnyNumberOfRanks) {
  const Known known{300, 20, {30.0, 29.0, 7.0, 1.0, 0.1, 0.05, 0.01, 2e-3}};
  const Pod alone = pod(known.snapshots(*self()), settings(GetParam(), 8), *self());
  const Pod together = pod(known.snapshots(*world()), settings(GetParam(), 8), *world());
  const int begin = known.first(*world(), world()->getRank());
  for (std::size_t k = 0; k < 8; ++k) {
    // Eigenvalues of SᵀS carry errors of ε σ_1², so singular values of ε σ_1²/σ.
    const double round_off = 10 * 2.2e-16 * 30.0 * 30.0 / known.sigma[k];
    EXPECT_NEAR(together.singular_values[k], alone.singular_values[k], std::max(1e-12, round_off));
    for (std::size_t i = 0; i < together.modes.extent(0); ++i) {
      EXPECT_NEAR(together.modes(i, k), alone.modes(begin + i, k), 1e-7);
    }
  }
}

TEST_P(PodOf, TakesMoreSnapshotsThanRows) {
  const Known known{10, 40, {4.0, 3.0, 2.0}};
  const Pod result = pod(known.snapshots(*world()), settings(GetParam(), 3), *world());
  EXPECT_NEAR(result.singular_values[2], 2.0, 1e-12);
  EXPECT_LT(result.orthogonality, 1e-12);
}

TEST_P(PodOf, HoldsMoreThan128Columns) {
  Known known{400, 160, {}};
  for (int k = 0; k < 150; ++k) known.sigma.push_back(std::pow(0.97, k));
  const Pod result = pod(known.snapshots(*world()), settings(GetParam(), 150), *world());
  for (int k = 0; k < 150; ++k) EXPECT_NEAR(result.singular_values[k], known.sigma[k], 1e-11);
  EXPECT_LT(result.orthogonality, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, PodOf, testing::Values("gram", "tsqr", "randomised"));

TEST(Pod, GramAndTsqrAgreeWithTheirSigns) {
  const Known known{180, 15, {12.0, 6.0, 3.0, 1.5, 0.7}};
  const Pod gram = pod(known.snapshots(*world()), settings("gram", 5), *world());
  const Pod tsqr = pod(known.snapshots(*world()), settings("tsqr", 5), *world());
  for (std::size_t k = 0; k < 5; ++k) {
    for (std::size_t i = 0; i < gram.modes.extent(0); ++i) EXPECT_NEAR(gram.modes(i, k), tsqr.modes(i, k), 1e-11);
  }
}

TEST(Pod, GramIsOrthonormalisedAgainWhereItLostOrthogonality) {
  const Known known{120, 8, {1.0, 1e-2, 1e-4, 1e-6, 1e-7}};
  const Pod result = pod(known.snapshots(*world()), settings("gram", 5), *world());
  EXPECT_TRUE(result.reorthogonalised);
  EXPECT_LT(result.orthogonality, 1e-13);
}

TEST(Pod, TsqrResolvesWhatGramCannot) {
  const Known known{120, 8, {1.0, 1e-3, 1e-6, 1e-10}};
  const Pod result = pod(known.snapshots(*world()), settings("tsqr", 4), *world());
  EXPECT_NEAR(result.singular_values[3], 1e-10, 1e-15);
  EXPECT_EQ(message([&] { pod(known.snapshots(*world()), settings("gram", 4), *world()); }),
            "reduction.basis.rank: 4 basis vectors are asked for, but of 8 snapshots only 3 are independent (singular "
            "values above 4.7e-08 of the largest); expected a rank of at most 3");
}

TEST(Pod, RandomisedTruncatesADecayingSpectrum) {
  Known known{300, 120, {}};
  for (int k = 0; k < 100; ++k) known.sigma.push_back(std::pow(0.8, k));
  const Pod result = pod(known.snapshots(*world()), settings("randomised", 12), *world());
  ASSERT_EQ(result.modes.extent(1), 12u);
  EXPECT_NEAR(result.truncation.energy, 1.0 - std::pow(0.64, 12), 1e-9) << "of what it has not seen too";
  const int begin = known.first(*world(), world()->getRank());
  for (int k = 0; k < 12; ++k) {
    EXPECT_NEAR(result.singular_values[k], known.sigma[k], 1e-8 * known.sigma[k]);
    double cosine_of_angle = 0.0;
    for (std::size_t i = 0; i < result.modes.extent(0); ++i) {
      cosine_of_angle += result.modes(i, k) * cosine(begin + static_cast<int>(i), k + 1, 300);
    }
    sum_over_ranks(*world(), &cosine_of_angle, 1);
    EXPECT_NEAR(std::abs(cosine_of_angle), 1.0, 1e-9) << k;
  }
}

/// Three times as many snapshots as may be held give the modes that all of them give.
TEST(Snapshots, WithALimitGiveThePodOfAll) {
  const Known known{200, 90, {50.0, 20.0, 3.0, 0.4, 1e-3, 1e-6}};
  const Snapshots all = known.snapshots(*world());
  Snapshots some(all.rows());
  some.limit(30, world());
  for (std::size_t j = 0; j < all.count(); ++j) {
    some.append(Kokkos::subview(all.matrix(), Kokkos::ALL, j));
    EXPECT_LE(some.count(), 30u);
  }
  EXPECT_EQ(some.appended(), 90u);
  EXPECT_LT(some.discarded_energy(), 1e-25);
  const Pod exact = pod(known.snapshots(*world()), settings("tsqr", 6), *world());
  const Pod merged = pod(some, settings("tsqr", 6), *world());
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(merged.singular_values[k], exact.singular_values[k], 1e-13 * 50.0);
    double cosine_of_angle = 0.0;
    for (std::size_t i = 0; i < exact.modes.extent(0); ++i) cosine_of_angle += exact.modes(i, k) * merged.modes(i, k);
    sum_over_ranks(*world(), &cosine_of_angle, 1);
    EXPECT_NEAR(std::abs(cosine_of_angle), 1.0, 1e-8) << k;
  }
}

/// Lets this process take so many bytes more than it has, while it stands.
class MemoryCap {
 public:
  explicit MemoryCap(rlim_t more) {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    const rlimit capped{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_AS, &capped), 0);
  }
  MemoryCap(const MemoryCap&) = delete;
  MemoryCap& operator=(const MemoryCap&) = delete;
  ~MemoryCap() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_;
};

/// 96 MiB of snapshots where 32 MiB may be taken.
TEST(Snapshots, WithALimitFitInAThirdOfTheirOwnSize) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  constexpr std::size_t rows = 16384, columns = 768;
  VectorView column("column", rows);
  const auto feed = [&column](Snapshots& snapshots) {
    for (std::size_t j = 0; j < columns; ++j) {
      for (std::size_t i = 0; i < rows; ++i) column(i) = cosine(static_cast<int>(i), static_cast<int>(j % 5) + 1, rows);
      snapshots.append(column);
    }
  };
  Snapshots all(rows), some(rows);
  some.limit(64, world());
  const MemoryCap cap(rlim_t{32} << 20);
  EXPECT_THROW(feed(all), std::bad_alloc);
  all.clear();
  feed(some);
  EXPECT_EQ(some.appended(), columns);
  EXPECT_LT(some.discarded_energy(), 1e-20);
  const Pod result = pod(some, settings("tsqr", 5), *world());
  // Five orthogonal columns, each of them so often.
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(result.singular_values[k] / result.singular_values[0], 1.0, 0.01);
  }
}

TEST(Snapshots, TellWhatALimitTooLowLeavesOut) {
  const Known known{200, 40, {4.0, 3.0, 2.0, 1.0, 0.5}};
  const Snapshots all = known.snapshots(*world());
  Snapshots some(all.rows());
  some.limit(6, world());
  for (std::size_t j = 0; j < all.count(); ++j) some.append(Kokkos::subview(all.matrix(), Kokkos::ALL, j));
  // At most three vectors survive a merge; what Σσ² = 30.25 loses with the others is told.
  EXPECT_GT(some.discarded_energy(), 0.005);
  EXPECT_LT(some.discarded_energy(), 0.1);
}

TEST(Pod, RandomisedTellsOfAllSnapshotsHowFewAreIndependent) {
  const Known known{200, 60, {4.0, 3.0, 2.0}};
  EXPECT_EQ(message([&] { pod(known.snapshots(*world()), settings("randomised", 5), *world()); }),
            "reduction.basis.rank: 5 basis vectors are asked for, but of 60 snapshots only 3 are independent (singular "
            "values above 1.3e-13 of the largest); expected a rank of at most 3");
}

TEST(Pod, ZeroSnapshotsAreRefused) {
  const Known known{20, 4, {0.0}};
  EXPECT_EQ(message([&] { pod(known.snapshots(*world()), settings("gram", 1), *world()); }),
            "reduction.basis: all 4 snapshots are zero; expected snapshots that differ from the reference state");
}

TEST(Truncation, FollowsItsRules) {
  PodSettings s;
  const std::vector<double> sigma{3.0, 2.0, 1.0, 1e-9};  // Σσ² = 14, Σσ = 6; the last is round-off for gram
  const auto rank = [&](double energy, PodSettings::EnergyOf of) {
    s.energy = energy;
    s.energy_of = of;
    return truncate(sigma, sigma.size(), s).rank;
  };
  using Of = PodSettings::EnergyOf;
  EXPECT_EQ(rank(0.5, Of::squared_singular_values), 1);  // 9/14 = 0.643
  EXPECT_EQ(rank(0.642, Of::squared_singular_values), 1);
  EXPECT_EQ(rank(0.644, Of::squared_singular_values), 2);
  EXPECT_EQ(rank(0.93, Of::squared_singular_values), 3);  // 13/14 = 0.929
  EXPECT_EQ(rank(0.5, Of::singular_values), 1);           // 3/6
  EXPECT_EQ(rank(0.501, Of::singular_values), 2);
  EXPECT_EQ(rank(0.84, Of::singular_values), 3);  // 5/6 = 0.833
  EXPECT_EQ(rank(1.0, Of::squared_singular_values), 3);
  EXPECT_EQ(truncate(sigma, sigma.size(), s).independent, 3);
  s.algorithm = PodSettings::Algorithm::tsqr;
  EXPECT_EQ(truncate(sigma, sigma.size(), s).independent, 4);
  s.energy.reset();
  s.rank = 2;
  EXPECT_NEAR(truncate(sigma, sigma.size(), s).energy, 13.0 / 14.0, 1e-15);
  s.at_least = 3;
  EXPECT_EQ(truncate(sigma, sigma.size(), s).rank, 2);  // asked for by number
  s.rank.reset();
  EXPECT_EQ(rank(0.5, Of::squared_singular_values), 3);
  s.at_least = 9;
  EXPECT_EQ(rank(0.5, Of::squared_singular_values), 4);
}

TEST(Tsqr, ReproducesTheMatrix) {
  const Known known{60, 7, {5.0, 4.0, 3.0, 2.0, 1.0, 0.5, 0.1}};
  const Snapshots original = known.snapshots(*world()), overwritten = known.snapshots(*world());
  const Tsqr factors(overwritten.matrix(), *world());
  const MatrixView again = factors.apply(factors.r());
  for (std::size_t j = 0; j < 7; ++j) {
    EXPECT_GE(factors.r()(j, j), 0.0);
    for (std::size_t i = 0; i < original.rows(); ++i) EXPECT_NEAR(again(i, j), original.matrix()(i, j), 1e-13);
  }
}

TEST(Snapshots, GrowAndRefuseOtherLengths) {
  Snapshots snapshots(3);
  VectorView column("column", 3);
  for (int j = 0; j < 100; ++j) {
    for (int i = 0; i < 3; ++i) column(i) = 10.0 * j + i;
    snapshots.append(column);
  }
  for (int j = 0; j < 100; ++j) EXPECT_EQ(snapshots.matrix()(2, j), 10.0 * j + 2);
  EXPECT_EQ(message([&] { snapshots.append(VectorView("short", 2)); }), "snapshot 100: 2 values; expected 3");
}

TEST(Snapshots, RestartAsNewInRoomTheyHave) {
  const Known known{200, 40, {4.0, 3.0, 2.0, 1.0, 0.5}};
  const Snapshots all = known.snapshots(*world());
  const auto append_all = [&all](Snapshots& to) {
    for (std::size_t j = 0; j < all.count(); ++j) to.append(Kokkos::subview(all.matrix(), Kokkos::ALL, j));
  };
  Snapshots fresh(all.rows()), again(all.rows());
  fresh.limit(12, world());
  again.limit(12, world());
  again.reserve(1000);  // no more than the limit
  VectorView other("other", all.rows());
  Kokkos::deep_copy(other, 7.0);
  for (int j = 0; j < 20; ++j) again.append(other);
  const double* place = again.matrix().data();
  again.restart();
  EXPECT_EQ(again.count(), 0u);
  EXPECT_EQ(again.appended(), 0u);
  EXPECT_EQ(again.discarded_energy(), 0.0);
  append_all(fresh);
  append_all(again);
  EXPECT_EQ(again.matrix().data(), place);
  EXPECT_EQ(again.count(), fresh.count());
  EXPECT_EQ(again.discarded_energy(), fresh.discarded_energy());
  for (std::size_t k = 0; k < fresh.matrix().size(); ++k) {
    ASSERT_EQ(again.matrix().data()[k], fresh.matrix().data()[k]) << k;
  }
}

}  // namespace
}  // namespace kiln
