#include "unit_tests/framework/model/ModelContract.hpp"

#include <gtest/gtest-spi.h>

#include <Tpetra_Core.hpp>

#include "framework/files/Hdf5.hpp"
#include "framework/model/MaskedModel.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/framework/model/TestModels.hpp"

namespace kiln {
namespace {

using Names = std::vector<std::string>;

Teuchos::RCP<const Communicator> world() { return Tpetra::getDefaultComm(); }

std::shared_ptr<DiffusionChain> chain() {
  return std::make_shared<DiffusionChain>(DiffusionChain::Settings{}, world());
}

std::shared_ptr<PendulumRing> ring() { return std::make_shared<PendulumRing>(11, world()); }

const std::vector<GlobalIndex> rows{17, 3, 4, 22, 0};

TEST(ModelContract, DiffusionChainHoldsIt) {
  const auto model = chain();
  contract::check_sampled(*model, rows);
  EXPECT_EQ(contract::check_jacobian_against_finite_differences(*model, contract::disturbed_state(*model), 0.3),
            (Names{"action", "diagonal", "matrix"}));
  EXPECT_EQ(contract::check_parameters(*model), (Names{"conduction", "reaction"}));
}

TEST(ModelContract, PendulumRingHoldsIt) {
  const auto model = ring();
  EXPECT_EQ(contract::check_jacobian_against_finite_differences(*model, contract::disturbed_state(*model), 0.3),
            Names{});
  EXPECT_EQ(contract::check_parameters(*model), (Names{"gravity", "coupling"}));
  EXPECT_THROW(model->sampled({0}), NotOffered);
}

TEST(ModelContract, RegisteredModelsComeByName) {
  Teuchos::ParameterList list("model");
  list.set("type", std::string("test pendulum ring"));
  list.set("particles", 7);
  EXPECT_EQ(Registry<Model>::create(list, {world()})->rows()->getGlobalNumElements(), 7u);
}

/// The chain with a mistake of a size a user could overlook.
class BrokenChain : public DiffusionChain {
 public:
  enum class Mistake { rate, diagonal, action };
  explicit BrokenChain(Mistake mistake) : DiffusionChain(Settings{}, world()), mistake_(mistake) {}
  void rate(ConstVectorView u, double time, VectorView f) const override {
    DiffusionChain::rate(u, time, f);
    if (mistake_ == Mistake::rate && f.extent(0) > 0) f(0) += 1e-9;
  }
  void rate_jacobian_diagonal(ConstVectorView u, double time, VectorView d) const override {
    DiffusionChain::rate_jacobian_diagonal(u, time, d);
    if (mistake_ == Mistake::diagonal && d.extent(0) > 0) d(0) *= 1.0001;
  }
  void apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView p) const override {
    DiffusionChain::apply_rate_jacobian(u, time, v, p);
    if (mistake_ == Mistake::action && p.extent(0) > 0) p(0, 0) += 1e-3;
  }

 private:
  Mistake mistake_;
};

// GoogleTest's failure catchers take statements that see no local variables.
void check_broken_sample() {
  const BrokenChain model(BrokenChain::Mistake::rate);
  contract::check_sampled(model, {0, 1, 2});
}
void check_broken_diagonal() {
  const BrokenChain model(BrokenChain::Mistake::diagonal);
  contract::check_jacobian_against_finite_differences(model, contract::disturbed_state(model), 0.3);
}
void check_broken_action() {
  const BrokenChain model(BrokenChain::Mistake::action);
  contract::check_jacobian_against_finite_differences(model, contract::disturbed_state(model), 0.3);
}

/// Whether `check` reports a failure on any rank.
bool fails(void (*check)()) {
  testing::TestPartResultArray results;
  {
    testing::ScopedFakeTestPartResultReporter catcher(
        testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    check();
  }
  return contract::largest_over_ranks(*world(), results.size()) > 0.0;
}

TEST(ModelContract, MistakesAreSeen) {
  EXPECT_TRUE(fails(check_broken_sample));
  EXPECT_TRUE(fails(check_broken_diagonal));
  EXPECT_TRUE(fails(check_broken_action));
}

TEST(MaskedModel, EqualsTheFullModelOnItsRows) {
  const auto line = chain();
  const MaskedModel masked(line, rows);
  contract::check_sampled(*line, masked, rows, 0.2, 0.0);
  EXPECT_EQ(contract::check_jacobian_against_finite_differences(masked, contract::disturbed_state(masked), 0.3),
            (Names{"action", "diagonal", "matrix"}));
  const auto two = ring();
  contract::check_sampled(*two, MaskedModel(two, {9, 2}), {9, 2}, 0.2, 0.0);
}

TEST(MaskedModel, EqualsTheModelThatSamplesItself) {
  const auto line = chain();
  const MaskedModel masked(line, rows);
  contract::check_sampled(masked, *line->sampled(rows), rows);
}

TEST(MaskedModel, SharesTheFullModelsParameters) {
  const auto line = chain();
  MaskedModel masked(line, rows);
  EXPECT_EQ(contract::check_parameters(masked), (Names{"conduction", "reaction"}));
  masked.parameters().set("conduction", 8.5);
  EXPECT_EQ(line->parameters().get("conduction"), 8.5);
}

TEST(MaskedModel, TakesThePlaceOfASampleThatIsNotOffered) {
  EXPECT_EQ(dynamic_cast<MaskedModel*>(sampled_or_masked(chain(), rows).get()), nullptr);
  auto two = ring();
  const std::weak_ptr<PendulumRing> watched = two;
  const auto masked = sampled_or_masked(std::move(two), {4, 7});
  two.reset();
  EXPECT_NE(dynamic_cast<MaskedModel*>(masked.get()), nullptr);
  EXPECT_FALSE(watched.expired()) << "the masked model keeps the full one";
  contract::check_sampled(*masked, {7});
  EXPECT_THROW(masked->sampled({5}), InputError);
}

TEST(MaskedModel, RefusesRowsThatAreNone) {
  EXPECT_THROW(MaskedModel(chain(), {3, 23}), InputError);
  EXPECT_THROW(MaskedModel(chain(), {3, 4, 3}), InputError);
}

TEST(MaskedModel, SavesTheIdsOfItsRows) {
  TestFolder folder;
  auto file = hdf5::File::create(folder / "sample.h5", world());
  MaskedModel(chain(), rows).save_sample(file);
  EXPECT_EQ(file.integers("rows").values, (std::vector<long long>{0, 3, 4, 17, 22}));
}

}  // namespace
}  // namespace kiln
