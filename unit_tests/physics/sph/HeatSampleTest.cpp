#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <numeric>

#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/physics/sph/HeatCase.hpp"

namespace kiln {
namespace {

constexpr double time = 2e-4;

std::vector<GlobalIndex> some_rows() {
  std::vector<GlobalIndex> rows;
  for (GlobalIndex id = 640; id >= 0; id -= 37) rows.push_back(id);
  rows.push_back(645);
  return rows;
}

/// Of the largest value, about a hundred units in the last place: a lattice's weights come from its spacing, listed
/// ones from the rounded positions.
constexpr double round_off = 2e-14;

double largest(const VectorView& values) {
  double result = 0.0;
  for (std::size_t i = 0; i < values.extent(0); ++i) result = std::max(result, std::abs(values(i)));
  return result;
}

double tangent(GlobalIndex id, int column) { return std::cos(0.7 * static_cast<double>(id) + column); }

/// J V for columns that depend on the particles' ids only.
MatrixView action_of(const Model& model, int columns) {
  MatrixView v("v", model.sources()->getNodeNumElements(), columns);
  for (std::size_t i = 0; i < v.extent(0); ++i) {
    for (int c = 0; c < columns; ++c) {
      v(i, c) = tangent(model.sources()->getGlobalElement(static_cast<LocalIndex>(i)), c);
    }
  }
  MatrixView product("product", model.rows()->getNodeNumElements(), columns);
  model.apply_rate_jacobian(rough_state(model), time, v, product);
  return product;
}

/// rate and diagonal of a sampled model, to the round-off that two layouts of the same pairs may differ by, and the
/// action of its Jacobian, bit for bit: those of the whole one. `whole` lives on this rank alone.
void expect_same(const Model& sample, const Model& whole) {
  const VectorView u = rough_state(whole);
  const VectorView f = rate_of(whole, u, time);
  VectorView diagonal("diagonal", f.extent(0));
  whole.rate_jacobian_diagonal(u, time, diagonal);
  const MatrixView action = action_of(whole, 3);

  const VectorView sample_u = rough_state(sample);
  const VectorView sample_f = rate_of(sample, sample_u, time);
  VectorView sample_diagonal("diagonal", sample_f.extent(0));
  sample.rate_jacobian_diagonal(sample_u, time, sample_diagonal);
  const MatrixView sample_action = action_of(sample, 3);
  for (std::size_t i = 0; i < sample_f.extent(0); ++i) {
    const GlobalIndex id = sample.rows()->getGlobalElement(static_cast<LocalIndex>(i));
    const LocalIndex row = whole.rows()->getLocalElement(id);
    EXPECT_NEAR(sample_f(i), f(row), round_off * largest(f)) << "particle " << id;
    EXPECT_NEAR(sample_diagonal(i), diagonal(row), round_off * largest(diagonal)) << "particle " << id;
    for (int c = 0; c < 3; ++c) EXPECT_EQ(sample_action(i, c), action(row, c)) << "particle " << id;
  }
}

void expect_rows(const Model& sample, std::vector<GlobalIndex> rows) {
  EXPECT_EQ(sample.rows()->getGlobalNumElements(), rows.size());
  EXPECT_TRUE(sample.rows()->isOneToOne());
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(sample.rows()->getNodeNumElements()); ++i) {
    const GlobalIndex id = sample.rows()->getGlobalElement(i);
    EXPECT_EQ(std::count(rows.begin(), rows.end(), id), 1);
    EXPECT_EQ(sample.sources()->getGlobalElement(i), id);
    if (i > 0) {
      EXPECT_LT(sample.rows()->getGlobalElement(i - 1), id);
    }
  }
}

TEST(HeatSample, EvaluatesItsRows) {
  const auto whole = HeatCase().model(alone());
  const auto sample = HeatCase().model()->sampled(some_rows());
  expect_rows(*sample, some_rows());
  expect_same(*sample, *whole);
}

TEST(HeatSample, OfAllRowsIsTheModel) {
  const auto model = HeatCase().model();
  std::vector<GlobalIndex> rows(648);
  std::iota(rows.begin(), rows.end(), GlobalIndex{0});
  const auto sample = model->sampled(rows);
  EXPECT_TRUE(sample->rows()->isSameAs(*model->rows()));
  EXPECT_TRUE(sample->sources()->isSameAs(*model->sources()));
  expect_same(*sample, *HeatCase().model(alone()));
}

TEST(HeatSample, OfASampleKeepsTheContract) {
  const auto sample = HeatCase().model()->sampled(some_rows())->sampled({640, 603, 307, 48});
  expect_rows(*sample, {640, 603, 307, 48});
  expect_same(*sample, *HeatCase().model(alone()));
}

TEST(HeatSample, TakesParametersAlong) {
  const auto model = HeatCase().model();
  model->parameters().set("heat_source.power", 90.0);
  const auto sample = model->sampled(some_rows());
  EXPECT_EQ(sample->parameters().get("heat_source.power"), 90.0);
  sample->parameters().set("heat_source.power", 70.0);
  EXPECT_EQ(model->parameters().get("heat_source.power"), 90.0);
  HeatCase changed;
  changed.heat_source.set("power", 70.0);
  expect_same(*sample, *changed.model(alone()));
}

TEST(HeatSample, WrongRowsAreNamed) {
  const auto model = HeatCase().model();
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
}

TEST(HeatSample, IsRestoredOnAnyNumberOfRanks) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const auto sample = HeatCase().model()->sampled(some_rows());
  {
    hdf5::File file = hdf5::File::create(folder / "sample.h5", everyone);
    hdf5::Group group = file.create_group("model");
    sample->save_sample(group);
  }
  // What the file must not be needed for: particles, kernel, material.
  Teuchos::ParameterList list = HeatCase().list();
  list.remove("particles");
  list.remove("kernel");
  list.remove("material");
  const auto whole = HeatCase().model(alone());
  for (const bool together : {true, false}) {
    const auto communicator = together ? everyone : alone();
    const hdf5::File file = hdf5::File::read(folder / "sample.h5", communicator);
    ASSERT_TRUE(Registry<Model>::restorable(list));
    const auto restored = Registry<Model>::restore(list, {communicator}, file.group("model"));
    expect_rows(*restored, some_rows());
    expect_same(*restored, *whole);
    if (together && everyone->getSize() <= 3) {
      EXPECT_GE(restored->rows()->getNodeNumElements(), 19u / everyone->getSize() - 2);
    }
  }
}

TEST(HeatSample, FileDoesNotDependOnTheNumberOfRanks) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const auto save = [&](const std::string& name, const Teuchos::RCP<const Communicator>& communicator) {
    hdf5::File file = hdf5::File::create(folder / name, communicator);
    hdf5::Group group = file.create_group("model");
    HeatCase().model(communicator)->sampled(some_rows())->save_sample(group);
  };
  save("together.h5", everyone);
  const std::string own = "alone-" + std::to_string(everyone->getRank()) + ".h5";
  save(own, alone());
  const hdf5::File together = hdf5::File::read(folder / "together.h5", everyone);
  const hdf5::File single = hdf5::File::read(folder / own, alone());
  for (const char* name : {"rows", "sources", "offsets", "neighbours"}) {
    EXPECT_EQ(together.group("model").integers(name).values, single.group("model").integers(name).values) << name;
  }
  for (const char* name : {"positions", "masses", "heated_areas", "weights"}) {
    EXPECT_EQ(together.group("model").reals(name).values, single.group("model").reals(name).values) << name;
  }
}

TEST(HeatSample, ATableOfOtherTemperaturesIsRefused) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  {
    hdf5::File file = hdf5::File::create(folder / "sample.h5", everyone);
    hdf5::Group group = file.create_group("model");
    HeatCase().model()->sampled(some_rows())->save_sample(group);
  }
  Teuchos::ParameterList list = HeatCase().list();
  list.sublist("table").set("to", TableRange::of(list).to + 1.0);
  const hdf5::File file = hdf5::File::read(folder / "sample.h5", everyone);
  try {
    Registry<Model>::restore(list, {everyone}, file.group("model"));
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("material/properties: has "), std::string::npos) << error.what();
  }
}

TEST(HeatSample, DamagedFileIsNamed) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  {
    hdf5::File file = hdf5::File::create(folder / "sample.h5", everyone);
    hdf5::Group group = file.create_group("model");
    HeatCase().model()->sampled(some_rows())->save_sample(group);
    hdf5::Group broken = file.create_group("broken");
    const auto whole = file.group("model");
    for (const char* name : {"rows", "sources", "offsets"}) broken.write(name, whole.integers(name).values);
    for (const char* name : {"masses", "heated_areas", "weights"}) broken.write(name, whole.reals(name).values);
    broken.write("positions", whole.reals("positions"));
    std::vector<long long> neighbours = whole.integers("neighbours").values;
    neighbours[3] = 5000;
    broken.write("neighbours", neighbours);
  }
  const hdf5::File file = hdf5::File::read(folder / "sample.h5", everyone);
  try {
    restored_domain(file.group("broken"), everyone);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("broken/neighbours: does not fit the sample"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace kiln
