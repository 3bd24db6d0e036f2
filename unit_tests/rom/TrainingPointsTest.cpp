#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "Projections.hpp"
#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/method/Trainer.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using test::Case;
using test::train;
using test::world;

/// A reaction strong enough for histories at 20 W and 60 W to differ in more than a factor.
Case chain(const std::string& folder) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.tolerance = 1e-8;
  values.iterations = 40;
  values.reaction = 100.0;
  values.basis_rank = 8;
  values.residual_rank = 12;
  values.samples = 24;
  values.windows = 2;
  return values;
}

/// Largest error of the reduction's queried particles at the end of a run at `power`, relative to the full order's.
double error_at(const Case& values, double power) {
  const auto at_the_end = [&](const char* method) {
    const std::unique_ptr<Method> run = test::method_of(values, method, world());
    run->parameters().set("power", power);
    return test::march(*run, values);
  };
  const std::vector<double> exact = at_the_end("fom"), reduced = at_the_end("gnat");
  double worst = 0.0;
  for (const int query : {29, 59}) worst = std::max(worst, std::abs(reduced[query] - exact[query]) / exact[query]);
  return worst;
}

TEST(TrainingPoints, SpanWhatLiesBetweenThem) {
  const TestFolder folder;
  Case values = chain(folder.path().string());
  train(values, world());
  const double from_one = std::max(error_at(values, 22.0), error_at(values, 57.0));
  values.train_on = {20.0, 40.0, 60.0};
  train(values, world());
  const double from_three = std::max(error_at(values, 22.0), error_at(values, 57.0));
  EXPECT_LT(from_three, 0.2 * from_one);
}

/// At the points learnt from and at those only tried, the report and the file tell what a user finds.
TEST(TrainingPoints, AreTriedOneByOne) {
  const TestFolder folder;
  Case values = chain(folder.path().string());
  values.train_on = {20.0, 60.0};
  values.try_on = {90.0};
  RunReport report = train(values, world());
  const nlohmann::json& facts = report.section("training");
  EXPECT_EQ(facts["full_order"]["runs"], 3);
  EXPECT_EQ(facts["state_snapshots"], 2 * values.steps);
  const nlohmann::json& points = facts["trial"]["points"];
  ASSERT_EQ(points.size(), 3u);
  double worst = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double power = std::vector<double>{20.0, 60.0, 90.0}[k], stated = points[k]["worst_query_error"];
    EXPECT_EQ(points[k]["at"]["power"], power);
    EXPECT_EQ(points[k]["learnt"], k < 2);
    EXPECT_GE(stated, error_at(values, power) * (1.0 - 1e-6)) << power << " W";
    worst = std::max(worst, stated);
  }
  EXPECT_EQ(facts["trial"]["worst_query_error"], worst);
  // What was not learnt is told worse, and the statement says so.
  EXPECT_EQ(points[2]["worst_query_error"], worst);
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  EXPECT_EQ(nlohmann::json::parse(file.text("trial"))["points"], points);
  EXPECT_EQ(file.group("parameters").real("power"), 40.0);
}

TEST(TrainingPoints, LeaveTheOneOfTheInputAloneWhenOnlyTried) {
  const TestFolder folder;
  Case values = chain(folder.path().string());
  train(values, world());
  const double alone = error_at(values, 40.0);
  values.try_on = {60.0};
  RunReport report = train(values, world());
  EXPECT_EQ(report.section("training")["trial"]["points"].size(), 2u);
  EXPECT_NEAR(error_at(values, 40.0), alone, 1e-9);
}

TEST(TrainingPoints, AreTheModelsOwn) {
  const TestFolder folder;
  Teuchos::ParameterList input = test::input_of(chain(folder.path().string()));
  Teuchos::ParameterList& block = input.sublist("reduction").sublist("train_on");
  block.setName("reduction.train_on");
  block.set("grid", false);
  block.sublist("points").setName("reduction.train_on.points");
  block.sublist("points").set("pwoer", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("1")));
  RunReport report;
  const auto trainer = Registry<Trainer>::create(input.sublist("reduction"), Trainer::Context{input, world(), true});
  try {
    trainer->train(folder.path() / "reduction.h5", report);
    FAIL() << "a misspelt parameter was taken";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("reduction.train_on.points.pwoer"), std::string::npos) << text;
    EXPECT_NE(text.find("power"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace kiln
