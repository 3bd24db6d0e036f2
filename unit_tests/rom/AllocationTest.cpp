#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cerrno>

#include "Projections.hpp"
#include "framework/method/Trainer.hpp"
#include "framework/time/TimeLoop.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

// Every allocation of the process passes through here: those of C++, Kokkos, MPI and HDF5 alike.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

std::atomic<long long> allocations{0}, bytes{0}, largest{0};

[[maybe_unused]] void note(std::size_t size) {
  ++allocations;
  bytes += static_cast<long long>(size);
  long long known = largest;
  while (static_cast<long long>(size) > known && !largest.compare_exchange_weak(known, size)) {
  }
}

void forget() { allocations = bytes = largest = 0; }

}  // namespace

#if !defined(__SANITIZE_ADDRESS__)
extern "C" {
void* malloc(std::size_t size) {
  note(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) {
  note(size);
  return __libc_realloc(pointer, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note(size);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** pointer, std::size_t alignment, std::size_t size) {
  *pointer = memalign(alignment, size);
  return *pointer == nullptr ? ENOMEM : 0;
}
}
#endif

namespace kiln {
namespace {

using test::Case;
using test::world;

#if defined(__SANITIZE_ADDRESS__)
#define KILN_NEEDS_HOOKS() GTEST_SKIP() << "the sanitizer owns malloc"
#else
#define KILN_NEEDS_HOOKS() (void)0
#endif

Case small_case(const std::string& folder, int count) {
  Case values;
  values.folder = folder;
  values.count = count;
  values.steps = 12;
  values.basis_rank = 4;
  values.residual_rank = 5;
  values.samples = 10;
  values.tolerance = 1e-4;
  values.jacobian = "diagonal";
  values.clustering = "per row";
  return values;
}

struct Use {
  long long largest, bytes;
};

/// What creating a method and running it allocates.
Use online(Case values, const std::string& type) {
  values.method = type;
  const Teuchos::ParameterList input = test::input_of(values);
  forget();
  {
    const auto method = Registry<Method>::create(input.sublist("method"), Method::Context{input, world()});
    const auto scheme = Registry<TimeScheme>::create(input.sublist("time").sublist("scheme"),
                                                     TimeScheme::Context{*method, values.step});
    VectorView x("x", local_size(*method->coordinates()));
    method->initial(x);
    scheme->start(x, 0.0);
    run_time_loop(*method, *scheme, x, {values.step, 0, values.steps}, {});
  }
  return {largest, bytes};
}

TEST(Online, HyperReducedMethodsAllocateNothingOfFullSize) {
  KILN_NEEDS_HOOKS();
  constexpr int small = 20000, large = 8 * small;
  std::vector<Use> gnat, ptrom, galerkin;
  for (const int count : {small, large}) {
    const TestFolder folder;
    const Case values = small_case(folder.path().string(), count);
    const Teuchos::ParameterList input = test::input_of(values);
    RunReport report;
    Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, world()})
        ->train(values.folder + "/reduction.h5", report);
    gnat.push_back(online(values, "gnat"));
    ptrom.push_back(online(values, "ptrom"));
    galerkin.push_back(online(values, "galerkin"));
  }
  const int ranks = world()->getSize();
  const long long vector_of_all = static_cast<long long>(large) * sizeof(double) / ranks;
  // The hooks see what grows: a method of full size holds vectors of a rank's share of the particles, and many of them.
  EXPECT_GE(galerkin[1].largest, vector_of_all);
  EXPECT_GT(galerkin[1].bytes - galerkin[0].bytes, 10 * vector_of_all * 7 / 8);
  for (const std::vector<Use>& hyper_reduced : {gnat, ptrom}) {
    EXPECT_LT(hyper_reduced[1].largest, vector_of_all);
    EXPECT_LE(hyper_reduced[1].largest, hyper_reduced[0].largest + 1024);
    EXPECT_LT(hyper_reduced[1].bytes - hyper_reduced[0].bytes, vector_of_all / 4);
  }
}

TEST(Online, AFrozenIterationAllocatesNothing) {
  KILN_NEEDS_HOOKS();
  if (world()->getSize() > 1) GTEST_SKIP() << "MPI allocates for its messages as it likes";
  Case values;
  values.refresh = 1000;
  const std::shared_ptr<Model> full = test::model_of(values, world());
  std::vector<GlobalIndex> rows;
  for (int id = 0; id < values.count; id += 2) rows.push_back(id);
  const auto method = test::gnat_projection(full->sampled(rows), values, 8, 16);
  VectorView x("x", 8), history("h", method->row_size()), u("u", method->row_size()), f("f", method->row_size());
  method->evaluate(x, 0.0, u, f);
  for (std::size_t i = 0; i < u.extent(0); ++i) history(i) = -u(i);
  const StepResidual step{1.0, values.step, values.step, history};
  method->solve(step, x, u, f);
  for (std::size_t i = 0; i < u.extent(0); ++i) history(i) = -u(i);
  forget();
  const SolveReport report = method->solve(step, x, u, f);
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(report.iterations, 2);
}

}  // namespace
}  // namespace kiln
