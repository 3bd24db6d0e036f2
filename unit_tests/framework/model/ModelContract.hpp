#pragma once

#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "framework/base/Error.hpp"
#include "framework/model/Model.hpp"

/// What every model promises (framework/model/Model.hpp), as tests for any registered one. All functions are
/// collective over the model's communicator and report failures through GoogleTest.
namespace kiln::contract {

/// A number in [−1, 1] that depends on the arguments alone: the same field on any number of ranks.
inline double pattern(GlobalIndex particle, int component, int seed) {
  const double x = 12.9898 * static_cast<double>(particle + 1) + 78.233 * (component + 1) + 37.719 * (seed + 1);
  return std::sin(x * std::sin(x));
}

inline double largest_over_ranks(const Communicator& communicator, double value) {
  double largest = 0.0;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &value, &largest);
  return largest;
}

inline double largest_entry(const Communicator& communicator, ConstVectorView values) {
  double largest = 0.0;
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
  for (std::size_t i = 0; i < host.extent(0); ++i) largest = std::max(largest, std::abs(host(i)));
  return largest_over_ranks(communicator, largest);
}

inline std::size_t row_size(const Model& model) { return local_size(*model.rows()) * model.fields().size(); }
inline std::size_t source_size(const Model& model) { return local_size(*model.sources()) * model.fields().size(); }

/// pattern() over the sources, times `scale`.
inline VectorView pattern_over_sources(const Model& model, double scale, int seed) {
  const int components = static_cast<int>(model.fields().size());
  VectorView values("kiln::test::pattern", source_size(model));
  const auto host = Kokkos::create_mirror_view(values);
  for (LocalIndex i = 0; i < local_size(*model.sources()); ++i) {
    for (int c = 0; c < components; ++c) {
      host(i * components + c) = scale * pattern(model.sources()->getGlobalElement(i), c, seed);
    }
  }
  Kokkos::deep_copy(values, host);
  return values;
}

/// The initial state of the sources, disturbed by `relative` times its largest entry (1 for a state of zeros), so that
/// terms which vanish in a uniform state count.
inline VectorView disturbed_state(const Model& model, double relative = 0.05) {
  const VectorView u("kiln::test::state", source_size(model));
  model.initial_state(u);
  const double largest = largest_entry(*model.rows()->getComm(), u);
  const VectorView noise = pattern_over_sources(model, relative * (largest > 0.0 ? largest : 1.0), 0);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  const auto add = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), noise);
  for (std::size_t i = 0; i < host.extent(0); ++i) host(i) += add(i);
  Kokkos::deep_copy(u, host);
  return u;
}

/// Entries of `values` (over the particles of `map`) by particle, as far as this rank has them.
inline std::map<GlobalIndex, std::vector<double>> by_particle(const Map& map, ConstVectorView values, int components) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
  std::map<GlobalIndex, std::vector<double>> result;
  for (LocalIndex i = 0; i < local_size(map); ++i) {
    result[map.getGlobalElement(i)].assign(host.data() + i * components, host.data() + (i + 1) * components);
  }
  return result;
}

/// rate(u)[rows] == sampled(rows).rate(u[its sources]) to `tolerance` of the largest rate, and likewise the initial
/// state, the positions and every Jacobian form that both offer. Also the maps: each wanted row on the rank that has it
/// in the full model, in ascending order, ahead of the other sources. `sampled` is the model to test.
inline void check_sampled(const Model& model, const Model& sampled, const std::vector<GlobalIndex>& rows,
                          double time = 0.1, double tolerance = 1e-13) {
  const Communicator& communicator = *model.rows()->getComm();
  const int components = static_cast<int>(model.fields().size());
  std::vector<GlobalIndex> expected;
  for (GlobalIndex row : rows) {
    if (model.rows()->isNodeGlobalElement(row)) expected.push_back(row);
  }
  std::sort(expected.begin(), expected.end());
  std::vector<GlobalIndex> found;
  for (LocalIndex i = 0; i < local_size(*sampled.rows()); ++i) found.push_back(sampled.rows()->getGlobalElement(i));
  EXPECT_EQ(found, expected) << "rows of the sampled model on this rank";
  std::set<GlobalIndex> distinct;
  for (LocalIndex i = 0; i < local_size(*sampled.sources()); ++i) {
    distinct.insert(sampled.sources()->getGlobalElement(i));
    if (i < local_size(*sampled.rows())) {
      EXPECT_EQ(sampled.sources()->getGlobalElement(i), sampled.rows()->getGlobalElement(i)) << "rows lead the sources";
    }
  }
  EXPECT_EQ(distinct.size(), std::size_t(local_size(*sampled.sources()))) << "a source is listed twice";
  ASSERT_EQ(sampled.fields().size(), model.fields().size());

  const VectorView u = disturbed_state(model), f("kiln::test::rate", row_size(model));
  const VectorView us("kiln::test::sampled state", source_size(sampled));
  const VectorView fs("kiln::test::sampled rate", row_size(sampled));
  // Every source of a sampled row is a source of the full model on the same rank: both own the same rows.
  const auto states = by_particle(*model.sources(), u, components);
  const auto host = Kokkos::create_mirror_view(us);
  for (LocalIndex i = 0; i < local_size(*sampled.sources()); ++i) {
    const auto state = states.find(sampled.sources()->getGlobalElement(i));
    ASSERT_NE(state, states.end()) << "source " << sampled.sources()->getGlobalElement(i)
                                   << " is none of the full model";
    std::copy(state->second.begin(), state->second.end(), host.data() + i * components);
  }
  Kokkos::deep_copy(us, host);

  const auto expect_same = [&](const char* what, ConstVectorView full, ConstVectorView part, const Map& full_map,
                               const Map& part_map) {
    const double allowed = tolerance * largest_entry(communicator, full);
    const auto wanted = by_particle(full_map, full, components);
    for (const auto& [particle, values] : by_particle(part_map, part, components)) {
      for (int c = 0; c < components; ++c) {
        EXPECT_NEAR(values[c], wanted.at(particle)[c], allowed) << what << " of particle " << particle;
      }
    }
  };
  model.rate(u, time, f);
  sampled.rate(us, time, fs);
  expect_same("rate", f, fs, *model.rows(), *sampled.rows());
  EXPECT_GT(largest_entry(communicator, f), 0.0) << "a rate of zeros shows nothing";

  const VectorView start("kiln::test::start", source_size(model));
  const VectorView sampled_start("kiln::test::sampled start", source_size(sampled));
  model.initial_state(start);
  sampled.initial_state(sampled_start);
  expect_same("initial state", start, sampled_start, *model.sources(), *sampled.sources());

  try {
    model.rate_jacobian_diagonal(u, time, f);
    sampled.rate_jacobian_diagonal(us, time, fs);
    expect_same("Jacobian diagonal", f, fs, *model.rows(), *sampled.rows());
  } catch (const NotOffered&) {
  }
  try {
    const VectorView v = pattern_over_sources(model, 1.0, 3), vs = pattern_over_sources(sampled, 1.0, 3);
    model.apply_rate_jacobian(u, time, ConstMatrixView(v.data(), v.extent(0), 1), MatrixView(f.data(), f.extent(0), 1));
    sampled.apply_rate_jacobian(us, time, ConstMatrixView(vs.data(), vs.extent(0), 1),
                                MatrixView(fs.data(), fs.extent(0), 1));
    expect_same("Jacobian product", f, fs, *model.rows(), *sampled.rows());
  } catch (const NotOffered&) {
  }
  try {
    const auto full = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), model.positions());
    const auto part = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), sampled.positions());
    for (LocalIndex i = 0; i < local_size(*sampled.sources()); ++i) {
      const LocalIndex j = model.sources()->getLocalElement(sampled.sources()->getGlobalElement(i));
      for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(part(i, axis), full(j, axis)) << "position of source " << i;
    }
  } catch (const NotOffered&) {
  }
  ASSERT_EQ(sampled.parameters().list().size(), model.parameters().list().size());
  for (std::size_t i = 0; i < model.parameters().list().size(); ++i) {
    EXPECT_EQ(sampled.parameters().list()[i].name, model.parameters().list()[i].name);
    EXPECT_EQ(*sampled.parameters().list()[i].value, *model.parameters().list()[i].value);
  }
}

/// The same for what the model itself returns from sampled(rows).
inline void check_sampled(const Model& model, const std::vector<GlobalIndex>& rows, double time = 0.1,
                          double tolerance = 1e-13) {
  check_sampled(model, *model.sampled(rows), rows, time, tolerance);
}

/// Whether the diagonal a model offers is the Jacobian's own, or a stated approximation that leaves terms out.
enum class Diagonal { exact, approximate };

/// Compares the Jacobian forms that the model offers with central differences of the rate at u (sources × components):
/// products with three fields to `tolerance` of the largest entry, matrix and action alike, and an exact diagonal by
/// differences in one particle and component at a time. Returns the forms it compared.
inline std::vector<std::string> check_jacobian_against_finite_differences(const Model& model, ConstVectorView u,
                                                                          double time,
                                                                          Diagonal diagonal = Diagonal::exact,
                                                                          double tolerance = 1e-6) {
  const Communicator& communicator = *model.rows()->getComm();
  const int components = static_cast<int>(model.fields().size());
  const std::size_t rows = row_size(model), sources = source_size(model);
  const double largest_u = largest_entry(communicator, u);
  const double step = std::cbrt(std::numeric_limits<double>::epsilon()) * (largest_u > 0.0 ? largest_u : 1.0);
  const auto state = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  const VectorView shifted("kiln::test::shifted", sources);
  const VectorView plus("kiln::test::plus", rows), minus("kiln::test::minus", rows),
      product("kiln::test::product", rows);

  const auto central = [&](const auto& direction) {
    const auto host = Kokkos::create_mirror_view(shifted);
    for (std::size_t i = 0; i < sources; ++i) host(i) = state(i) + step * direction(i);
    Kokkos::deep_copy(shifted, host);
    model.rate(shifted, time, plus);
    for (std::size_t i = 0; i < sources; ++i) host(i) = state(i) - step * direction(i);
    Kokkos::deep_copy(shifted, host);
    model.rate(shifted, time, minus);
    const auto p = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), plus);
    const auto m = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), minus);
    std::vector<double> result(rows);
    for (std::size_t i = 0; i < rows; ++i) result[i] = (p(i) - m(i)) / (2.0 * step);
    return result;
  };
  const auto expect_same = [&](const char* form, const std::vector<double>& expected, const auto& found) {
    double size = 0.0;
    for (double value : expected) size = std::max(size, std::abs(value));
    size = largest_over_ranks(communicator, size);
    for (std::size_t i = 0; i < rows; ++i) {
      EXPECT_NEAR(found(i), expected[i], tolerance * size)
          << form << ", particle " << model.rows()->getGlobalElement(static_cast<LocalIndex>(i / components))
          << ", component " << i % components;
    }
  };

  std::set<std::string> compared;
  for (int seed = 1; seed <= 3; ++seed) {
    const VectorView v = pattern_over_sources(model, 1.0, seed);
    const auto direction = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), v);
    const std::vector<double> expected = central(direction);
    try {
      model.apply_rate_jacobian(u, time, ConstMatrixView(v.data(), sources, 1), MatrixView(product.data(), rows, 1));
      expect_same("apply_rate_jacobian", expected, Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), product));
      compared.insert("action");
    } catch (const NotOffered&) {
    }
    try {
      const auto matrix = model.rate_jacobian_matrix(u, time);
      const auto local = matrix->getLocalMatrixHost();
      std::vector<double> values(rows, 0.0);
      for (std::size_t row = 0; row < rows; ++row) {
        for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
          const GlobalIndex column = matrix->getColMap()->getGlobalElement(local.graph.entries(k));
          const LocalIndex source = model.sources()->getLocalElement(column / components);
          values[row] += local.values(k) * direction(source * components + column % components);
        }
      }
      expect_same("rate_jacobian_matrix", expected, [&](std::size_t i) { return values[i]; });
      compared.insert("matrix");
    } catch (const NotOffered&) {
    }
  }
  try {
    model.rate_jacobian_diagonal(u, time, product);
    const auto offered = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), product);
    if (diagonal == Diagonal::exact) {
      std::vector<double> expected(rows);
      for (std::size_t i = 0; i < rows; ++i) {
        expected[i] = central([&](std::size_t j) { return i == j ? 1.0 : 0.0; })[i];
      }
      expect_same("rate_jacobian_diagonal", expected, offered);
    } else {
      for (std::size_t i = 0; i < rows; ++i) EXPECT_TRUE(std::isfinite(offered(i)));
    }
    compared.insert("diagonal");
  } catch (const NotOffered&) {
  }
  return {compared.begin(), compared.end()};
}

/// A rate is that of its arguments, whatever was asked for before: the same state at another time, another state in the
/// same array, a Jacobian.
inline void check_rate_has_no_memory(const Model& model, double time = 0.1, double other_time = 0.2) {
  const VectorView u = disturbed_state(model), other = disturbed_state(model), f("kiln::test::rate", row_size(model));
  const VectorView array("kiln::test::array", source_size(model));
  for (std::size_t i = 0; i < other.extent(0); ++i) other(i) *= 1.001;
  const auto rate = [&](const VectorView& state, double at) {
    Kokkos::deep_copy(array, state);
    model.rate(array, at, f);
    return std::vector<double>(f.data(), f.data() + f.extent(0));
  };
  const std::vector<double> here = rate(u, time), there = rate(other, other_time);
  EXPECT_EQ(rate(u, time), here);
  const std::vector<double> later = rate(u, other_time);
  EXPECT_EQ(rate(other, other_time), there);
  EXPECT_EQ(rate(u, other_time), later);
  EXPECT_EQ(rate(u, time), here);
  try {
    const VectorView diagonal("kiln::test::diagonal", row_size(model));
    model.rate_jacobian_diagonal(other, other_time, diagonal);
    EXPECT_EQ(rate(u, time), here);
    model.rate_jacobian_diagonal(u, time, diagonal);
    EXPECT_EQ(rate(u, time), here);
  } catch (const NotOffered&) {
    // Then there is none to remember.
  }
}

/// Parameters are named once, have a unit and a finite value, take new values and refuse bad ones; after each is set
/// back the rate is bitwise what it was. Returns those whose change by 1 % changes the rate at a disturbed state and
/// `time`, for the caller to compare with those that must.
inline std::vector<std::string> check_parameters(Model& model, double time = 0.1) {
  const Communicator& communicator = *model.rows()->getComm();
  const VectorView u = disturbed_state(model), f("kiln::test::rate", row_size(model));
  const auto rate = [&] {
    model.rate(u, time, f);
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  };
  const std::vector<double> before = rate();
  std::set<std::string> names;
  std::vector<std::string> live;
  for (const Parameter& parameter : model.parameters().list()) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name << " is listed twice";
    EXPECT_FALSE(parameter.unit.empty()) << parameter.name << " has no unit";
    const double value = model.parameters().get(parameter.name);
    EXPECT_TRUE(std::isfinite(value)) << parameter.name;
    const double changed = value == 0.0 ? 0.01 : 1.01 * value;
    model.parameters().set(parameter.name, changed);
    EXPECT_EQ(model.parameters().get(parameter.name), changed) << parameter.name;
    const bool here = rate() != before;
    if (largest_over_ranks(communicator, here ? 1.0 : 0.0) > 0.0) live.push_back(parameter.name);
    EXPECT_THROW(model.parameters().set(parameter.name, std::nan("")), InputError) << parameter.name;
    model.parameters().set(parameter.name, value);
    EXPECT_EQ(rate(), before) << "after " << parameter.name << " was set back";
  }
  EXPECT_THROW(model.parameters().get("no such parameter"), InputError);
  return live;
}

}  // namespace kiln::contract
