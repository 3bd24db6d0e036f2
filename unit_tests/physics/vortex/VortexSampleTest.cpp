#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

const std::vector<GlobalIndex> some_rows{211, 3, 60, 61, 62, 140, 0};

std::vector<double> at_rows(const std::vector<double>& whole, std::vector<GlobalIndex> rows) {
  std::sort(rows.begin(), rows.end());
  std::vector<double> result;
  for (const GlobalIndex id : rows) result.insert(result.end(), {whole[2 * id], whole[2 * id + 1]});
  return result;
}

/// The rate at chosen rows, by ascending id, on every rank.
std::vector<double> rate_at_rows(const Model& sample, std::vector<GlobalIndex> rows) {
  std::sort(rows.begin(), rows.end());
  const VectorView f = rate_of(sample, initial_state_of(sample));
  std::vector<double> mine(2 * rows.size(), 0.0), all(mine.size());
  for (LocalIndex i = 0; i < local_size(*sample.rows()); ++i) {
    const auto place = std::lower_bound(rows.begin(), rows.end(), sample.rows()->getGlobalElement(i)) - rows.begin();
    for (int c = 0; c < 2; ++c) mine[2 * place + c] = f(2 * i + c);
  }
  Teuchos::reduceAll(*sample.rows()->getComm(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(),
                     all.data());
  return all;
}

/// Rows go through the sums four at a time and share divides: others beside them round otherwise.
void expect_same(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-15) << "entry " << i;
}

TEST(VortexSample, IsTheWholeModelToRoundOff) {
  const auto whole = VortexCase().model();
  const std::vector<double> expected =
      at_rows(gathered(*whole->rows(), rate_of(*whole, initial_state_of(*whole))), some_rows);
  expect_same(rate_at_rows(*whole->sampled(some_rows), some_rows), expected);
  expect_same(rate_at_rows(*whole->sampled(some_rows)->sampled({60, 3}), {60, 3}),
              at_rows(gathered(*whole->rows(), rate_of(*whole, initial_state_of(*whole))), {60, 3}));
}

TEST(VortexSample, TakesParametersAlong) {
  const auto whole = VortexCase().model();
  whole->parameters().set("kernel.core_radius", 0.3);
  whole->parameters().set("circulation_scale", 1.5);
  const auto sample = whole->sampled(some_rows);
  EXPECT_EQ(sample->parameters().get("kernel.core_radius"), 0.3);
  contract::check_sampled(*whole, *sample, some_rows);
  sample->parameters().set("circulation_scale", 1.0);
  EXPECT_EQ(whole->parameters().get("circulation_scale"), 1.5);
}

TEST(VortexSample, WrongRowsAreNamed) {
  const auto model = VortexCase().model();
  const auto message = [&model](const std::vector<GlobalIndex>& rows) -> std::string {
    try {
      model->sampled(rows);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_NE(message({5, 9999}).find("particle 9999 is no row of the model"), std::string::npos);
  EXPECT_NE(message({5, 7, 5}).find("particle 5 is sampled twice"), std::string::npos);
  EXPECT_THROW(model->pair_weights({-1}), InputError);
}

TEST(VortexSample, PairWeightsAreTheCirculationsOfAllOthers) {
  const auto model = VortexCase().model();
  const VortexCloud cloud = VortexCase().cloud();
  const PairWeights pairs = model->pair_weights({44, 2});
  EXPECT_EQ(pairs.rows, (std::vector<GlobalIndex>{2, 44}));
  ASSERT_EQ(pairs.sources.size(), 2 * (cloud.x.size() - 1));
  EXPECT_EQ(pairs.offsets, (std::vector<std::size_t>{0, cloud.x.size() - 1, 2 * (cloud.x.size() - 1)}));
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t pair = pairs.offsets[r]; pair < pairs.offsets[r + 1]; ++pair) {
      EXPECT_NE(pairs.sources[pair], pairs.rows[r]);
      EXPECT_EQ(pairs.weights[pair], cloud.circulation[pairs.sources[pair]]);
    }
  }
}

TEST(VortexSample, IsRestoredOnAnyNumberOfRanks) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const auto sample = VortexCase().model()->sampled(some_rows);
  {
    hdf5::File file = hdf5::File::create(folder / "sample.h5", everyone);
    hdf5::Group group = file.create_group("model");
    sample->save_sample(group);
  }
  const std::vector<double> expected = rate_at_rows(*sample, some_rows);
  // What the file must not be needed for.
  Teuchos::ParameterList list = VortexCase().list();
  list.remove("particles");
  for (const bool together : {true, false}) {
    const auto communicator = together ? everyone : alone();
    const hdf5::File file = hdf5::File::read(folder / "sample.h5", communicator);
    ASSERT_TRUE(Registry<Model>::restorable(list));
    const auto restored = Registry<Model>::restore(list, {communicator}, file.group("model"));
    EXPECT_EQ(restored->rows()->getGlobalNumElements(), some_rows.size());
    expect_same(rate_at_rows(*restored, some_rows), expected);
    if (together) {
      const auto rows = static_cast<std::size_t>(local_size(*restored->rows()));
      EXPECT_GE(rows, some_rows.size() / everyone->getSize());
    }
  }
}

TEST(VortexSample, DamagedFileIsNamed) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  {
    hdf5::File file = hdf5::File::create(folder / "sample.h5", everyone);
    hdf5::Group group = file.create_group("model");
    VortexCase().model()->sampled(some_rows)->save_sample(group);
    const auto copy = [&](const char* name) {
      hdf5::Group broken = file.create_group(name);
      broken.attribute("particles", group.integer("particles"));
      return broken;
    };
    hdf5::Group rows = copy("rows");
    rows.write("rows", std::vector<long long>{0, 5000});
    rows.write("sources", group.integers("sources").values);
    hdf5::Group infinite = copy("circulations");
    infinite.write("rows", group.integers("rows").values);
    infinite.write("sources", group.integers("sources").values);
    infinite.write("positions", group.reals("positions"));
    std::vector<double> circulations = group.reals("circulations").values;
    circulations[4] = std::numeric_limits<double>::infinity();
    infinite.write("circulations", circulations);
  }
  const hdf5::File file = hdf5::File::read(folder / "sample.h5", everyone);
  for (const std::string name : {"rows", "circulations"}) {
    try {
      restored_table(file.group(name));
      FAIL() << name;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("/" + name + "/" + name + ": does not fit the sample"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(VortexModel, ArraysOfTheWrongLengthAreRefused) {
  const auto model = VortexCase().model();
  const VectorView f("f", contract::row_size(*model));
  EXPECT_THROW(model->rate(VectorView("u", 3), 0.0, f), std::invalid_argument);
  EXPECT_THROW(model->initial_state(VectorView("u", 3)), std::invalid_argument);
}

}  // namespace
}  // namespace kiln
