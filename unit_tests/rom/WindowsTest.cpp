#include <gtest/gtest.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "Projections.hpp"
#include "framework/base/Collectives.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/time/TimeLoop.hpp"
#include "rom/basis/AffineBasis.hpp"
#include "rom/linear_algebra/Dense.hpp"
#include "rom/pod/Pod.hpp"
#include "rom/training/TimeWindows.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"

namespace kiln {
namespace {

using test::Case;
using test::largest_difference;
using test::march;
using test::model_of;
using test::self;
using test::train;
using test::world;

/// Two windows of two modes each, on five particles.
struct TwoWindows {
  TwoWindows() {
    for (std::size_t i = 0; i < 5; ++i) {
      reference(i) = 300.0 + 10.0 * static_cast<double>(i);
      for (std::size_t k = 0; k < 4; ++k) modes(i, k) = std::sin(1.0 + 2.3 * static_cast<double>(i * 4 + k));
    }
  }
  AffineBasis second(std::shared_ptr<const TrialSpace> first = nullptr) const { return {reference, modes, 2, first}; }
  std::shared_ptr<const TrialSpace> first() const {
    return std::make_shared<AffineBasis>(reference, dense::leading_columns(ConstMatrixView(modes), 2));
  }
  VectorView state(const TrialSpace& space, const std::vector<double>& coordinates) const {
    const VectorView x("x", 4), u("u", 5);
    std::copy(coordinates.begin(), coordinates.end(), x.data());
    space.state(x, u);
    return u;
  }
  VectorView reference{"reference", 5};
  MatrixView modes{"modes", 5, 4};
};

TEST(AffineBasis, BeginsWhereTheWindowBeforeItEnds) {
  const TwoWindows windows;
  const AffineBasis second = windows.second(windows.first()), alone = windows.second();
  // There, elsewhere, and back: what is kept of one place must not serve at another.
  for (const double scale : {1.0, -2.0, 1.0}) {
    const std::vector<double> x{3.0 * scale, -4.0, 5.0, 6.0 * scale};
    const VectorView u = windows.state(second, x), expected = windows.state(alone, x);
    const VectorView anew = windows.state(windows.second(windows.first()), x);
    for (std::size_t i = 0; i < 5; ++i) {
      double sum = windows.reference(i);
      for (std::size_t k = 0; k < 4; ++k) sum += windows.modes(i, k) * x[k];
      EXPECT_NEAR(u(i), sum, 1e-12);
      EXPECT_NEAR(u(i), expected(i), 1e-12);
      EXPECT_EQ(u(i), anew(i)) << "a restart must find the same bits";
    }
  }
}

TEST(AffineBasis, RefusesAWindowBeforeItThatEndsElsewhere) {
  const TwoWindows windows;
  EXPECT_THROW(AffineBasis(windows.reference, windows.modes, 3, windows.first()), std::logic_error);
}

/// A reduced method of several windows, each on all cosines: nothing is left out, so that only the hand-over can go
/// wrong. The windows end at steps 7, 15 and 25; GNAT samples other particles in each.
std::unique_ptr<PetrovGalerkin> in_three_windows(const std::string& kind, const Case& values,
                                                 const Teuchos::RCP<const Communicator>& communicator) {
  const int all = values.count * values.components;
  const std::vector<TimeWindow> windows{
      {7 * values.step, 0, all}, {15 * values.step, all, all}, {25 * values.step, 2 * all, all}};
  const std::shared_ptr<Model> full = model_of(values, communicator);
  const auto three_times = [&](const Map& map) {
    const MatrixView one = test::cosines(map, values.components, all, all);
    const MatrixView modes("modes", one.extent(0), 3 * all);
    for (int w = 0; w < 3; ++w) {
      Kokkos::deep_copy(Kokkos::subview(modes, Kokkos::ALL, std::make_pair(w * all, (w + 1) * all)), one);
    }
    return modes;
  };
  const auto on = [&](const std::shared_ptr<Model>& model, const std::function<std::unique_ptr<TestBasis>()>& basis) {
    return test::parts_of(model, values, three_times(*model->sources()), windows, basis);
  };
  if (kind == "galerkin") return std::make_unique<PetrovGalerkin>(on(full, test::galerkin_test), newton_of(values));
  if (kind == "lspg") return std::make_unique<PetrovGalerkin>(on(full, test::lspg_test), newton_of(values));
  // All particles in an order that the window's model decides: rows are dealt to ranks anew in each.
  PetrovGalerkin::Parts parts = on(full, test::lspg_test);
  for (std::size_t w = 0; w < 3; ++w) {
    std::vector<GlobalIndex> ids(values.count);
    for (int i = 0; i < values.count; ++i) ids[i] = i;
    const std::shared_ptr<Model> sampled = full->sampled(ids);
    PetrovGalerkin::Parts of_window = on(sampled, test::gnat_test(*sampled, values, all));
    parts.windows[w].projection = std::move(of_window.windows[w].projection);
  }
  return std::make_unique<PetrovGalerkin>(std::move(parts), newton_of(values));
}

struct MethodAndScheme {
  const char* method;
  const char* scheme;
};
void PrintTo(const MethodAndScheme& p, std::ostream* out) { *out << p.method << ", " << p.scheme; }

class ThreeWindows : public testing::TestWithParam<MethodAndScheme> {
 protected:
  ThreeWindows() {
    values_.count = 20;
    values_.steps = 25;
    values_.scheme = GetParam().scheme;
    values_.components = 2;
  }
  Case values_;
};

TEST_P(ThreeWindows, HandOverExactly) {
  FullOrder full(
      model_of(values_, world()), newton_of(values_),
      Registry<LinearSolver>::create(input_of(values_).sublist("time").sublist("newton").sublist("linear_solver"), {}));
  const std::vector<double> exact = march(full, values_);
  const auto reduced = in_three_windows(GetParam().method, values_, world());
  EXPECT_LT(largest_difference(march(*reduced, values_), exact), 1e-9);
  // A second run of the same method begins in the first window again.
  EXPECT_LT(largest_difference(march(*reduced, values_), exact), 1e-9);
}

/// With method and scheme of the run before, as queries use them; also where that run ended within a window, the first
/// one among them, whose frozen Jacobian would serve the next run.
TEST_P(ThreeWindows, BeginAnewBitByBit) {
  values_.refresh = 7;
  values_.tolerance = 1e-3;
  values_.jacobian = "diagonal";
  const int size = 3 * values_.count * values_.components;
  const auto method = in_three_windows(GetParam().method, values_, world());
  const auto scheme = Registry<TimeScheme>::create(input_of(values_).sublist("time").sublist("scheme"),
                                                   TimeScheme::Context{*method, values_.step});
  const auto run = [&](int steps) {
    const VectorView x("x", size);
    method->forget();
    method->initial(x);
    scheme->start(x, 0.0);
    run_time_loop(*method, *scheme, x, {values_.step, 0, steps}, {});
    return std::vector<double>(x.data(), x.data() + size);
  };
  const std::vector<double> first = run(25);
  EXPECT_EQ(run(25), first);
  for (const int steps : {5, 17}) {
    run(steps);
    EXPECT_EQ(run(25), first) << steps;
  }
}

TEST_P(ThreeWindows, RestartBitByBit) {
  const int size = 3 * values_.count * values_.components;
  // Within a window, at its end, and a step later.
  for (const int stop : {12, 15, 16}) {
    const auto whole = in_three_windows(GetParam().method, values_, world());
    const auto scheme_of = [this](Method& method) {
      return Registry<TimeScheme>::create(input_of(values_).sublist("time").sublist("scheme"),
                                          TimeScheme::Context{method, values_.step});
    };
    VectorView x("x", size), kept("kept", size);
    auto scheme = scheme_of(*whole);
    whole->initial(x);
    scheme->start(x, 0.0);
    run_time_loop(*whole, *scheme, x, {values_.step, 0, stop}, {});
    Kokkos::deep_copy(kept, x);
    const std::string file =
        std::string("windows_") + GetParam().method + GetParam().scheme + std::to_string(world()->getSize()) + ".h5";
    {
      hdf5::File out = hdf5::File::create(file, world());
      hdf5::Group method_group = out.create_group("method"), scheme_group = out.create_group("scheme");
      whole->save(method_group);
      scheme->save(scheme_group);
    }
    run_time_loop(*whole, *scheme, x, {values_.step, stop, 25}, {});

    const auto again = in_three_windows(GetParam().method, values_, world());
    auto restarted = scheme_of(*again);
    {
      const hdf5::File in = hdf5::File::read(file, world());
      again->restore(in.group("method"));
      restarted->restore(in.group("scheme"));
    }
    run_time_loop(*again, *restarted, kept, {values_.step, stop, 25}, {});
    for (int k = 0; k < size; ++k) EXPECT_EQ(kept(k), x(k)) << "stopped at " << stop << ", coordinate " << k;
    world()->barrier();
    if (world()->getRank() == 0) std::filesystem::remove(file);
    world()->barrier();
  }
}

INSTANTIATE_TEST_SUITE_P(Windows, ThreeWindows,
                         testing::Values(MethodAndScheme{"galerkin", "backward euler"}, MethodAndScheme{"lspg", "bdf2"},
                                         MethodAndScheme{"lspg", "rk4"}, MethodAndScheme{"gnat", "backward euler"},
                                         MethodAndScheme{"gnat", "bdf2"}, MethodAndScheme{"gnat", "trapezoidal"}));

Case training_case(const std::string& folder) {
  Case values;
  values.folder = folder;
  values.jacobian = "diagonal";
  values.iterations = 40;
  values.tolerance = 1e-8;
  values.basis_rank = 4;
  values.residual_rank = 6;
  values.samples = 15;
  return values;
}

std::vector<double> run(const Case& values, const std::string& type,
                        const Teuchos::RCP<const Communicator>& communicator) {
  return march(*test::method_of(values, type, communicator), values);
}

TEST(WindowTraining, OfAsManyModesIsMoreAccurateInMoreWindows) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  double last = 1.0;
  for (const int windows : {1, 4}) {
    values.windows = windows;
    RunReport report = train(values, world());
    const nlohmann::json& trial = report.section("training")["trial"];
    EXPECT_EQ(report.section("training")["time_windows"], windows);
    EXPECT_FALSE(trial["diverged"].get<bool>());
    EXPECT_LT(trial["field_l2_error"], 0.3 * last);
    last = trial["field_l2_error"];
  }
  EXPECT_LT(last, 0.01);
}

/// The trial run's errors are those a user finds by running both methods.
TEST(WindowTraining, StatesTheErrorOfItsReduction) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.windows = 3;
  RunReport report = train(values, world());
  const std::vector<double> exact = run(values, "fom", world()), reduced = run(values, "gnat", world());
  double worst = 0.0;
  for (const int query : {29, 59}) worst = std::max(worst, std::abs(reduced[query] - exact[query]) / exact[query]);
  const double stated = report.section("training")["trial"]["worst_query_error"];
  EXPECT_GE(stated, worst * (1.0 - 1e-9));  // the last step's error is one of those it is the largest of
  EXPECT_LT(stated, 0.1);
  EXPECT_GT(stated, 0.0);
  const hdf5::File file = hdf5::File::read(values.folder + "/reduction.h5", world());
  EXPECT_EQ(nlohmann::json::parse(file.text("trial"))["worst_query_error"], stated);
}

TEST(WindowTraining, CutsWindowsUntilTheErrorHolds) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.residual_rank = 12;
  values.samples = 30;
  int last = 0;
  for (const double wanted : {2e-2, 1e-3}) {
    values.window_error = wanted;
    RunReport report = train(values, world());
    const nlohmann::json& facts = report.section("training");
    EXPECT_LE(facts["trial"]["worst_query_error"], wanted);
    EXPECT_TRUE(facts["warnings"].empty()) << facts["warnings"];
    EXPECT_GT(facts["time_windows"], last);
    last = facts["time_windows"];
  }
}

TEST(WindowTraining, IsTheSameOnAnyNumberOfRanks) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.windows = 4;
  values.tolerance = 1e-10;
  values.algorithm = "tsqr";
  Case serial = values;
  serial.folder = folder / ("rank" + std::to_string(world()->getRank()));
  std::filesystem::create_directory(serial.folder);
  train(values, world());
  train(serial, self());
  for (const char* type : {"galerkin", "lspg", "gnat"}) {
    EXPECT_LT(largest_difference(run(values, type, world()), run(serial, type, self())), 1e-9) << type;
  }
}

/// What is held of the residuals has fewer modes than the states.
TEST(WindowTraining, WarnsOfFewerResidualModesThanCoordinates) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.windows = 2;
  values.basis_rank = values.residual_rank = 8;
  values.snapshots_hold = 9;
  const nlohmann::json facts = train(values, world()).section("training");
  ASSERT_LT(facts["residual_basis"][0]["rank"], facts["basis"][0]["rank"]);
  EXPECT_NE(facts["warnings"].dump().find("do not determine the coordinates"), std::string::npos) << facts["warnings"];
}

TEST(WindowedGnat, TakesNewValuesOfLiveParametersInEveryWindow) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.windows = 4;
  train(values, world());
  Case changed = values;
  changed.power = 44.0;
  const std::vector<double> from_the_input = run(changed, "gnat", world());
  values.method = "gnat";
  const Teuchos::ParameterList input = test::input_of(values);
  const auto method = Registry<Method>::create(input.sublist("method"), Method::Context{input, world()});
  method->parameters().set("power", 44.0);
  EXPECT_LT(largest_difference(march(*method, values), from_the_input), 1e-14);
}

/// What a further attempt learns from must be what the first one saw, which was one window.
TEST(WindowTraining, CutsOneWindowByTsqrAsByGram) {
  const TestFolder folder;
  Case values = training_case(folder.path().string());
  values.residual_rank = 12;
  values.samples = 30;
  values.window_error = 2e-2;
  std::vector<nlohmann::json> bases;
  for (const char* algorithm : {"gram", "tsqr"}) {
    values.algorithm = algorithm;
    RunReport report = train(values, world());
    bases.push_back(report.section("training")["basis"]);
  }
  ASSERT_EQ(bases[0].size(), bases[1].size());
  for (std::size_t w = 0; w < bases[0].size(); ++w) {
    EXPECT_EQ(bases[0][w]["rank"], bases[1][w]["rank"]);
    EXPECT_NEAR(bases[0][w]["energy"], bases[1][w]["energy"], 1e-9) << w;
  }
}

/// Random walks: every window's increments have a projection error that POD itself confirms.
TEST(WindowCosts, AreThoseOfAPodOfTheIncrements) {
  constexpr int rows = 40, count = 30;
  Snapshots states(rows);
  VectorView state("state", rows);
  unsigned random = 1u + static_cast<unsigned>(world()->getRank());
  double largest = 0.0;
  for (int n = 0; n < count; ++n) {
    for (int i = 0; i < rows; ++i) {
      random = random * 1664525u + 1013904223u;
      state(i) += random / 4294967296.0 - 0.5;
    }
    states.append(state);
    double square = 0.0;
    for (int i = 0; i < rows; ++i) square += state(i) * state(i);
    sum_over_ranks(*world(), &square, 1);
    largest = std::max(largest, std::sqrt(square));
  }
  const WindowCosts costs(states, *world());
  for (const auto& [begin, end, rank] : {std::tuple{0, 30, 5}, {0, 12, 3}, {9, 21, 4}, {21, 30, 1}}) {
    Snapshots increments(rows);
    for (int n = begin; n < end; ++n) {
      for (int i = 0; i < rows; ++i) state(i) = states.matrix()(i, n) - (begin > 0 ? states.matrix()(i, begin - 1) : 0);
      increments.append(state);
    }
    PodSettings settings;
    settings.rank = rank;
    const Pod basis = pod(increments, settings, *world());
    double missed = 0.0;
    for (std::size_t k = rank; k < basis.singular_values.size(); ++k) {
      missed += basis.singular_values[k] * basis.singular_values[k];
    }
    EXPECT_NEAR(costs.projection_error(begin, end, rank), std::sqrt(missed / (end - begin)) / largest, 1e-10);
  }
  // Windows are as long as the error allows: each holds it, and none could be a snapshot longer.
  const double error = 0.5 * costs.projection_error(0, count, 4);
  const std::vector<int> ends = windows_within(costs, 4, error);
  ASSERT_EQ(ends.back(), count);
  ASSERT_GT(ends.size(), 1u);
  int begin = 0;
  for (const int end : ends) {
    EXPECT_LE(costs.projection_error(begin, end, 4), error);
    if (end < count) {
      EXPECT_GT(costs.projection_error(begin, end + 1, 4), error);
    }
    begin = end;
  }
}

}  // namespace
}  // namespace kiln
