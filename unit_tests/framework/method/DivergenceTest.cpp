#include "framework/method/Divergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit_tests/framework/method/FullOrderCases.hpp"

namespace kiln {
namespace {

/// The chain with trouble at chosen particles from t = 0.25 s on.
class Troubled : public DiffusionChain {
 public:
  Troubled(std::vector<GlobalIndex> particles, double rate)
      : DiffusionChain({}, world()), particles_(std::move(particles)), rate_(rate) {}
  void rate(ConstVectorView u, double time, VectorView f) const override {
    DiffusionChain::rate(u, time, f);
    if (time < 0.25) return;
    for (GlobalIndex particle : particles_) {
      if (rows()->isNodeGlobalElement(particle)) f(rows()->getLocalElement(particle)) = rate_;
    }
  }

 private:
  std::vector<GlobalIndex> particles_;
  double rate_;
};

template <class Work>
std::string divergence_text(Work&& work) {
  try {
    work();
  } catch (const DivergenceError& error) {
    return error.what();
  }
  return "no DivergenceError";
}

void expect_in(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " not in: " << text;
}

TEST(Divergence, ANanNamesItsFirstParticleOnEveryRank) {
  for (const char* type : {"backward euler", "trapezoidal", "explicit euler", "rk4"}) {
    FullOrder method(std::make_shared<Troubled>(std::vector<GlobalIndex>{21, 14, 17}, std::nan("")),
                     newton(JacobianForm::diagonal, 1e-6));
    const std::string text = divergence_text([&] { run(method, type, 0.1, 5); });
    expect_in(text, {"particle 14 at (7, 0, 0) m", "not finite", "temperature = ", " K, its rate = nan K/s"});
  }
}

TEST(Divergence, TheTimeIsTheStepsOwn) {
  FullOrder method(std::make_shared<Troubled>(std::vector<GlobalIndex>{3}, std::nan("")),
                   newton(JacobianForm::diagonal, 1e-6));
  expect_in(divergence_text([&] { run(method, "backward euler", 0.1, 5); }),
            {"t = 0.3 s, particle 3 at (1.5, 0, 0) m"});
}

TEST(Divergence, AnInfinityIsFound) {
  FullOrder method(std::make_shared<Troubled>(std::vector<GlobalIndex>{22}, -INFINITY),
                   newton(JacobianForm::diagonal, 1e-6));
  expect_in(divergence_text([&] { run(method, "backward euler", 0.1, 5); }),
            {"particle 22 at (11, 0, 0) m", "-inf K/s"});
}

TEST(Divergence, AnOverflowingNormNamesTheLargestResidual) {
  FullOrder method(std::make_shared<Troubled>(std::vector<GlobalIndex>{9}, 1e200),
                   newton(JacobianForm::diagonal, 1e-6));
  expect_in(divergence_text([&] { run(method, "backward euler", 0.1, 5); }), {"particle 9 at (4.5, 0, 0) m", "1e+200"});
}

TEST(Divergence, GrowthIsStopped) {
  // A diagonal that is far too small makes each update overshoot 1000-fold.
  class Overshooting : public DiffusionChain {
   public:
    Overshooting() : DiffusionChain({}, world()) {}
    void rate_jacobian_diagonal(ConstVectorView, double, VectorView diagonal) const override {
      Kokkos::deep_copy(diagonal, 9.99);
    }
  };
  FullOrder method(std::make_shared<Overshooting>(), newton(JacobianForm::diagonal, 1e-6));
  expect_in(divergence_text([&] { run(method, "backward euler", 0.1, 5); }),
            {"t = 0.1 s, particle ", "the residual norm grew from ", "a growth by 1e+06 is taken as divergence"});
}

TEST(Divergence, ALinearSolveThatFailsIsNamed) {
  FullOrder method(std::make_shared<DiffusionChain>(DiffusionChain::Settings{}, world()),
                   newton(JacobianForm::matrix_free), krylov("bicgstab", 1e-12, "none", 2));
  expect_in(divergence_text([&] { run(method, "backward euler", 0.3, 1); }),
            {"t = 0.3 s: linear solver 'bicgstab' reached a relative residual of", "in 2 iterations"});
}

TEST(Divergence, AModelWithoutPositionsNamesTheParticle) {
  class Failing : public PendulumRing {
   public:
    Failing() : PendulumRing(11, world()) {}
    void rate(ConstVectorView u, double time, VectorView f) const override {
      PendulumRing::rate(u, time, f);
      if (rows()->isNodeGlobalElement(6)) f(2 * rows()->getLocalElement(6) + 1) = std::nan("");
    }
  };
  FullOrder method(std::make_shared<Failing>(), newton(JacobianForm::diagonal));
  const std::string text = divergence_text([&] { run(method, "rk4", 0.1, 1); });
  expect_in(text, {"particle 6: ", "angular velocity = ", "rad/s, its rate = nan rad/s/s"});
}

TEST(Divergence, TheStepIsAddedOnce) {
  const DivergenceError error("broke", 0.5, DivergenceError::Place{7, {}});
  EXPECT_STREQ(error.at_step(12).what(), "step 12, t = 0.5 s, particle 7: broke");
  EXPECT_STREQ(error.at_step(12).at_step(13).what(), "step 12, t = 0.5 s, particle 7: broke");
}

}  // namespace
}  // namespace kiln
