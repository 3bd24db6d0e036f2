#include "physics/sph/Kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

class KernelTest : public testing::TestWithParam<const char*> {
 protected:
  static constexpr double h = 0.7;
  std::unique_ptr<Kernel> kernel_ =
      Registry<Kernel>::create(Teuchos::ParameterList("kernel").set("type", std::string(GetParam())), {h});
};

TEST_P(KernelTest, IntegratesToOne) {
  const int n = 4000;
  double integral = 0.0;
  for (int i = 0; i < n; ++i) {
    const double r = 2.0 * h * (i + 0.5) / n;
    integral += kernel_->value(r) * 4.0 * M_PI * r * r * 2.0 * h / n;
  }
  EXPECT_NEAR(integral, 1.0, 1e-6);
}

TEST_P(KernelTest, GradientIsTheDerivativeOfItsValue) {
  const double step = 1e-5;
  for (const double r : {0.05, 0.3, 0.69, 0.71, 1.1, 1.39}) {
    const double difference = (kernel_->value(r + step) - kernel_->value(r - step)) / (2.0 * step);
    EXPECT_NEAR(kernel_->gradient_over_distance(r), difference / r, 1e-6 * kernel_->value(0.0)) << "r = " << r;
    EXPECT_LT(kernel_->gradient_over_distance(r), 0.0);
  }
}

TEST_P(KernelTest, EndsAtTwiceTheSmoothingLength) {
  EXPECT_GT(kernel_->value(2.0 * h * (1.0 - 1e-3)), 0.0);
  EXPECT_EQ(kernel_->value(2.0 * h), 0.0);
  EXPECT_EQ(kernel_->gradient_over_distance(2.0 * h), 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, KernelTest, testing::Values("cubic spline", "wendland c2"));

TEST(Kernels, PeakValues) {
  const auto peak = [](const char* name) {
    return Registry<Kernel>::create(Teuchos::ParameterList("kernel").set("type", std::string(name)), {2.0})->value(0.0);
  };
  EXPECT_DOUBLE_EQ(peak("cubic spline"), 1.0 / (8.0 * M_PI));
  EXPECT_DOUBLE_EQ(peak("wendland c2"), 21.0 / (128.0 * M_PI));
}

}  // namespace
}  // namespace kiln
