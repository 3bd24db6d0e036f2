#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "framework/files/Hdf5.hpp"
#include "framework/files/Unknown.hpp"
#include "framework/time/LinearMultistep.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/framework/method/FullOrderCases.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"

namespace kiln {
namespace {

bool same_bits(ConstVectorView a, ConstVectorView b) {
  const bool same = a.extent(0) == b.extent(0) && std::memcmp(a.data(), b.data(), a.extent(0) * sizeof(double)) == 0;
  return contract::largest_over_ranks(*world(), same ? 0.0 : 1.0) == 0.0;
}

using MakeMethod = std::function<std::unique_ptr<FullOrder>()>;
using MakeScheme = std::function<std::unique_ptr<TimeScheme>(Method&)>;

constexpr double step = 0.03;

/// Runs `last` steps at one go and once more with a break after `stop`, through a file; compares the bits.
void expect_bitwise_restart(const std::string& name, const MakeMethod& make_method, const MakeScheme& make_scheme,
                            int stop, int last) {
  TestFolder folder;
  const auto whole = make_method();
  const auto whole_scheme = make_scheme(*whole);
  const VectorView expected = initial(*whole);
  whole_scheme->start(expected, 0.0);
  advance(*whole_scheme, expected, step, 0, stop);
  {
    auto file = hdf5::File::create(folder / "checkpoint.h5", world());
    save_unknown(file, "x", *whole->coordinates(), expected);
    auto scheme_group = file.create_group("scheme");
    whole_scheme->save(scheme_group);
    auto method_group = file.create_group("method");
    whole->save(method_group);
  }
  advance(*whole_scheme, expected, step, stop, last);

  const auto again = make_method();
  const auto again_scheme = make_scheme(*again);
  const VectorView x("kiln::test::x", expected.extent(0));
  const auto file = hdf5::File::read(folder / "checkpoint.h5", world());
  restore_unknown(file, "x", *again->coordinates(), x);
  again->restore(file.group("method"));
  again_scheme->restore(file.group("scheme"));
  advance(*again_scheme, x, step, stop, last);
  EXPECT_TRUE(same_bits(x, expected)) << name << ", stopped after " << stop;
}

MakeScheme registered(const std::string& type) {
  return [type](Method& method) { return scheme(type, method, step); };
}

std::unique_ptr<FullOrder> chain(JacobianForm form, int refresh) {
  return std::make_unique<FullOrder>(std::make_shared<DiffusionChain>(DiffusionChain::Settings{}, world()),
                                     newton(form, 1e-5, 20, refresh), krylov("gmres", 1e-6));
}

TEST(Restart, EverySchemeContinuesToTheBit) {
  for (const char* type : {"backward euler", "explicit euler", "trapezoidal", "bdf2", "heun", "ssp rk3", "rk4"}) {
    for (int stop : {1, 5}) {
      expect_bitwise_restart(
          type, [] { return chain(JacobianForm::diagonal, 3); }, registered(type), stop, 9);
    }
  }
}

TEST(Restart, ALongHistoryComesBackWhileItIsFilling) {
  // BDF3: after one and two steps the history is still short.
  const MakeScheme bdf3 = [](Method& method) {
    return std::make_unique<LinearMultistep>(MultistepCoefficients{{11.0 / 6, -3, 1.5, -1.0 / 3}, {1, 0, 0, 0}},
                                             TimeScheme::Context{method, step});
  };
  for (int stop : {1, 2, 3, 4}) {
    expect_bitwise_restart(
        "bdf3", [] { return chain(JacobianForm::diagonal, 2); }, bdf3, stop, 7);
  }
}

TEST(Restart, EveryFrozenJacobianComesBack) {
  for (JacobianForm form :
       {JacobianForm::diagonal, JacobianForm::sparse, JacobianForm::matrix_free, JacobianForm::finite_difference}) {
    for (int refresh : {1, 4, 100}) {
      expect_bitwise_restart(
          to_text(form), [&] { return chain(form, refresh); }, registered("bdf2"), 3, 6);
    }
  }
}

TEST(Restart, TwoComponents) {
  const MakeMethod ring = [] {
    return std::make_unique<FullOrder>(std::make_shared<PendulumRing>(11, world()),
                                       newton(JacobianForm::finite_difference, 1e-6, 20, 4), krylov("gmres", 1e-4));
  };
  for (const char* type : {"trapezoidal", "rk4"}) expect_bitwise_restart(type, ring, registered(type), 3, 6);
}

TEST(Restart, ForgettingTheJacobianWouldShow) {
  // The negative control: without the frozen Jacobian's point the continued run differs.
  const auto whole = chain(JacobianForm::diagonal, 100), again = chain(JacobianForm::diagonal, 100);
  const auto whole_scheme = scheme("backward euler", *whole, step),
             again_scheme = scheme("backward euler", *again, step);
  const VectorView x = initial(*whole), y("kiln::test::y", x.extent(0));
  whole_scheme->start(x, 0.0);
  advance(*whole_scheme, x, step, 0, 5);
  Kokkos::deep_copy(y, x);
  again_scheme->start(y, 5 * step);
  advance(*whole_scheme, x, step, 5, 8);
  advance(*again_scheme, y, step, 5, 8);
  EXPECT_FALSE(same_bits(x, y));
}

TEST(Restart, AnotherSchemesHistoryIsRefused) {
  TestFolder folder;
  auto file = hdf5::File::create(folder / "checkpoint.h5", world());
  const auto method = chain(JacobianForm::diagonal, 3);
  const VectorView x = initial(*method);
  const auto bdf2 = scheme("bdf2", *method, step);
  bdf2->start(x, 0.0);
  advance(*bdf2, x, step, 0, 4);
  bdf2->save(file);
  EXPECT_THROW(scheme("backward euler", *method, step)->restore(file), FileError);
}

TEST(Unknown, ReplicatedOnesComeBackOnAnyRank) {
  TestFolder folder;
  const auto everywhere = Tpetra::createLocalMap<LocalIndex, GlobalIndex>(5, world());
  const VectorView x("kiln::test::x", 5), y("kiln::test::y", 5);
  for (int i = 0; i < 5; ++i) x(i) = 1.0 / (3.0 + i);
  auto file = hdf5::File::create(folder / "x.h5", world());
  save_unknown(file, "x", *everywhere, x);
  restore_unknown(file, "x", *everywhere, y);
  EXPECT_TRUE(same_bits(x, y));
  EXPECT_EQ(file.shape("x"), (std::vector<std::size_t>{5, 1})) << "the shape does not depend on the number of ranks";
  const auto longer = Tpetra::createLocalMap<LocalIndex, GlobalIndex>(6, world());
  const VectorView z("kiln::test::z", 6);
  EXPECT_THROW(restore_unknown(file, "x", *longer, z), FileError);
}

}  // namespace
}  // namespace kiln
