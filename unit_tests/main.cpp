#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

/// GoogleTest under MPI: only rank 0 reports passing tests, every rank reports its failures.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  Tpetra::ScopeGuard scope(&argc, &argv);
  const int rank = Tpetra::getDefaultComm()->getRank();
  if (rank != 0) {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  const int failed = RUN_ALL_TESTS();
  if (failed != 0 && rank != 0) {
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    std::fprintf(stderr, "rank %d: %d tests failed\n", rank, tests.failed_test_count());
  }
  return failed;
}
