#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "unit_tests/framework/files/TestFolder.hpp"
#include "unit_tests/framework/model/ModelContract.hpp"
#include "unit_tests/physics/vortex/VortexCase.hpp"

namespace kiln {
namespace {

const std::vector<GlobalIndex> rows{0, 3, 60, 61, 62, 140, 211};

/// Each particle a cluster of its own.
SourceClusters singletons(const VortexModel& model) {
  const PairWeights pairs = model.pair_weights(rows);
  SourceClusters clusters;
  clusters.rows = pairs.rows;
  clusters.row_offsets = pairs.offsets;
  for (std::size_t pair = pairs.sources.size(); pair-- > 0;) {
    // Against the order, which is not to matter.
    const std::size_t row = std::upper_bound(pairs.offsets.begin(), pairs.offsets.end(), pair) - pairs.offsets.begin();
    const std::size_t mirrored = pairs.offsets[row - 1] + pairs.offsets[row] - 1 - pair;
    clusters.row_clusters.resize(pairs.sources.size());
    clusters.row_weights.resize(pairs.sources.size());
    clusters.row_clusters[mirrored] = static_cast<std::size_t>(pairs.sources[pair]);
    clusters.row_weights[mirrored] = pairs.weights[pair];
  }
  clusters.member_offsets.push_back(0);
  for (GlobalIndex id = 0; id < static_cast<GlobalIndex>(model.rows()->getGlobalNumElements()); ++id) {
    clusters.members.push_back(id);
    clusters.shares.push_back(1.0);
    clusters.member_offsets.push_back(clusters.members.size());
  }
  return clusters;
}

/// Particles of like sign in the squares of a grid as clusters with their centres of circulation; squares nearer to a
/// row than `near` go particle by particle.
SourceClusters squares(const VortexCloud& cloud, double edge, double near = 0.6) {
  std::map<std::array<long long, 3>, std::vector<GlobalIndex>> cells;
  const auto cell_of = [&](std::size_t i) {
    return std::array<long long, 3>{static_cast<long long>(std::floor(cloud.x[i] / edge)),
                                    static_cast<long long>(std::floor(cloud.y[i] / edge)),
                                    cloud.circulation[i] < 0.0 ? 1 : 0};
  };
  for (std::size_t i = 0; i < cloud.x.size(); ++i) cells[cell_of(i)].push_back(static_cast<GlobalIndex>(i));
  SourceClusters clusters;
  clusters.member_offsets.push_back(0);
  const auto add = [&](const std::vector<GlobalIndex>& members) {
    double sum = 0.0;
    for (const GlobalIndex id : members) sum += cloud.circulation[id];
    for (const GlobalIndex id : members) {
      clusters.members.push_back(id);
      clusters.shares.push_back(cloud.circulation[id] / sum);
    }
    clusters.member_offsets.push_back(clusters.members.size());
    return std::pair{clusters.clusters() - 1, sum};
  };
  std::map<std::array<long long, 3>, std::pair<std::size_t, double>> numbers;
  for (const auto& [cell, members] : cells) numbers[cell] = add(members);
  clusters.rows = rows;
  clusters.row_offsets.push_back(0);
  for (const GlobalIndex row : rows) {
    for (const auto& [cell, members] : cells) {
      const double x = (static_cast<double>(cell[0]) + 0.5) * edge - cloud.x[row];
      const double y = (static_cast<double>(cell[1]) + 0.5) * edge - cloud.y[row];
      if (std::hypot(x, y) > near) {
        clusters.row_clusters.push_back(numbers[cell].first);
        clusters.row_weights.push_back(numbers[cell].second);
        continue;
      }
      for (const GlobalIndex id : members) {
        if (id == row) continue;
        const auto [number, circulation] = add({id});
        clusters.row_clusters.push_back(number);
        clusters.row_weights.push_back(circulation);
      }
    }
    clusters.row_offsets.push_back(clusters.row_clusters.size());
  }
  return clusters;
}

/// u of a clustered model's sources from the state of all particles: what a cluster's state is.
VectorView clustered_state(const Model& clustered, const SourceClusters& clusters, GlobalIndex particles,
                           const std::vector<double>& states) {
  const VectorView u("u", contract::source_size(clustered));
  for (LocalIndex j = 0; j < local_size(*clustered.sources()); ++j) {
    const GlobalIndex id = clustered.sources()->getGlobalElement(j);
    for (int c = 0; c < 2; ++c) {
      if (id < particles) {
        u(2 * j + c) = states[2 * id + c];
        continue;
      }
      const auto cluster = static_cast<std::size_t>(id - particles);
      for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
        u(2 * j + c) += clusters.shares[m] * states[2 * clusters.members[m] + c];
      }
    }
  }
  return u;
}

double tangent(GlobalIndex id, int component, int column) {
  return std::cos(0.7 * static_cast<double>(id) + component + 2 * column);
}

/// Tangents of all particles in a column.
std::vector<double> tangents(GlobalIndex particles, int column) {
  std::vector<double> values;
  for (GlobalIndex id = 0; id < particles; ++id) {
    values.insert(values.end(), {tangent(id, 0, column), tangent(id, 1, column)});
  }
  return values;
}

/// Largest difference of the rates of two models on the same rows, relative to the largest rate.
double difference(const Model& model, const VectorView& f, const VectorView& expected) {
  const Communicator& communicator = *model.rows()->getComm();
  double most = 0.0;
  for (std::size_t i = 0; i < f.extent(0); ++i) most = std::max(most, std::abs(f(i) - expected(i)));
  return contract::largest_over_ranks(communicator, most) / contract::largest_entry(communicator, expected);
}

TEST(VortexClusters, OfOneMemberEachAreTheSampledModel) {
  constexpr int columns = 5;
  for (const std::string kernel : {"rosenhead-moore", "lamb-oseen"}) {
    VortexCase vortex_case;
    vortex_case.kernel = kernel;
    const auto model = vortex_case.model();
    const auto particles = static_cast<GlobalIndex>(model->rows()->getGlobalNumElements());
    const SourceClusters clusters = singletons(*model);
    const auto sampled = model->sampled(rows), clustered = model->clustered(clusters);
    EXPECT_TRUE(clustered->rows()->isSameAs(*sampled->rows()));

    // Not the initial state: clusters move.
    std::vector<double> states = tangents(particles, 9);
    const VortexCloud cloud = vortex_case.cloud();
    for (GlobalIndex id = 0; id < particles; ++id) {
      states[2 * id] = cloud.x[id] + 0.05 * states[2 * id];
      states[2 * id + 1] = cloud.y[id] + 0.05 * states[2 * id + 1];
    }
    const VectorView u = clustered_state(*sampled, {}, particles, states);
    const VectorView u_clustered = clustered_state(*clustered, clusters, particles, states);
    const std::size_t entries = contract::row_size(*sampled);
    EXPECT_LT(difference(*model, rate_of(*clustered, u_clustered), rate_of(*sampled, u)), 1e-13);

    const VectorView diagonal("d", entries), diagonal_clustered("d", entries);
    sampled->rate_jacobian_diagonal(u, 0.0, diagonal);
    clustered->rate_jacobian_diagonal(u_clustered, 0.0, diagonal_clustered);
    EXPECT_LT(difference(*model, diagonal_clustered, diagonal), 1e-13);

    const MatrixView v("v", contract::source_size(*sampled), columns), product("p", entries, columns);
    const MatrixView v_clustered("v", contract::source_size(*clustered), columns),
        product_clustered("p", entries, columns);
    for (int c = 0; c < columns; ++c) {
      const std::vector<double> all = tangents(particles, c);
      Kokkos::deep_copy(Kokkos::subview(v, Kokkos::ALL, c), clustered_state(*sampled, {}, particles, all));
      Kokkos::deep_copy(Kokkos::subview(v_clustered, Kokkos::ALL, c),
                        clustered_state(*clustered, clusters, particles, all));
    }
    sampled->apply_rate_jacobian(u, 0.0, v, product);
    clustered->apply_rate_jacobian(u_clustered, 0.0, v_clustered, product_clustered);
    for (int c = 0; c < columns; ++c) {
      const VectorView expected("e", entries), found("f", entries);
      Kokkos::deep_copy(expected, Kokkos::subview(product, Kokkos::ALL, c));
      Kokkos::deep_copy(found, Kokkos::subview(product_clustered, Kokkos::ALL, c));
      EXPECT_LT(difference(*model, found, expected), 1e-13) << "column " << c;
    }
  }
}

TEST(VortexClusters, AreTheSourcesOfTheirModel) {
  const auto model = VortexCase().model();
  const auto particles = static_cast<GlobalIndex>(model->rows()->getGlobalNumElements());
  const SourceClusters clusters = squares(VortexCase().cloud(), 0.4);
  const auto clustered = model->clustered(clusters);
  const Map& sources = *clustered->sources();
  const LocalIndex own = local_size(*clustered->rows());
  for (LocalIndex j = 0; j < local_size(sources); ++j) {
    const GlobalIndex id = sources.getGlobalElement(j);
    const bool other = id >= particles || std::binary_search(rows.begin(), rows.end(), id);
    EXPECT_TRUE(j < own ? clustered->rows()->getLocalElement(id) == j : other)
        << "source " << id << ": the rows first, then those of other ranks and clusters from N on";
    if (j > 0 && j != own) {
      EXPECT_LT(sources.getGlobalElement(j - 1), id);
    }
  }
  // Places at t = 0 are the members' shares of theirs.
  std::vector<double> places;
  const VortexCloud cloud = VortexCase().cloud();
  for (std::size_t i = 0; i < cloud.x.size(); ++i) places.insert(places.end(), {cloud.x[i], cloud.y[i]});
  const VectorView expected = clustered_state(*clustered, clusters, particles, places);
  const VectorView found = initial_state_of(*clustered);
  const auto positions = clustered->positions();
  for (std::size_t i = 0; i < found.extent(0); ++i) {
    EXPECT_NEAR(found(i), expected(i), 1e-14);
    EXPECT_EQ(positions(i / 2, i % 2), found(i));
  }
  EXPECT_THROW(clustered->sampled({0}), NotOffered);
}

TEST(VortexClusters, JacobianIsThatOfTheClusteredRate) {
  for (const std::string kernel : {"rosenhead-moore", "lamb-oseen"}) {
    VortexCase vortex_case;
    vortex_case.kernel = kernel;
    const auto clustered = vortex_case.model()->clustered(squares(vortex_case.cloud(), 0.4));
    EXPECT_EQ(contract::check_jacobian_against_finite_differences(*clustered, initial_state_of(*clustered), 0.0),
              (std::vector<std::string>{"action", "diagonal"}));
    EXPECT_EQ(contract::check_parameters(*clustered),
              (std::vector<std::string>{"kernel.core_radius", "circulation_scale"}));
  }
}

TEST(VortexClusters, ErrorFallsWithTheSquareOfTheirSize) {
  VortexCase vortex_case;
  vortex_case.particles = VortexCase::two_patches(0.05);
  const auto model = vortex_case.model();
  const auto sampled = model->sampled(rows);
  const VectorView expected = rate_of(*sampled, initial_state_of(*sampled));
  const std::size_t pairs = rows.size() * (vortex_case.cloud().x.size() - 1);
  std::vector<double> errors;
  for (const double edge : {0.8, 0.4, 0.2}) {
    const SourceClusters clusters = squares(vortex_case.cloud(), edge, 1.0);
    const auto clustered = model->clustered(clusters);
    errors.push_back(difference(*model, rate_of(*clustered, initial_state_of(*clustered)), expected));
    if (model->rows()->getComm()->getRank() == 0) {
      std::printf("squares of %.1f m: %zu pairs of %zu, error %.2e\n", edge, clusters.row_clusters.size(), pairs,
                  errors.back());
    }
    EXPECT_LT(clusters.row_clusters.size(), pairs / 2);
  }
  EXPECT_LT(errors[0], 0.05);
  EXPECT_GT(errors[2], 1e-8) << "nothing is clustered";
  EXPECT_LT(errors[1], 0.4 * errors[0]);
  EXPECT_LT(errors[2], 0.4 * errors[1]);
}

TEST(VortexClusters, AreRestoredOnAnyNumberOfRanks) {
  const TestFolder folder;
  const auto everyone = Tpetra::getDefaultComm();
  const SourceClusters clusters = squares(VortexCase().cloud(), 0.4);
  const auto clustered = VortexCase().model()->clustered(clusters);
  {
    hdf5::File file = hdf5::File::create(folder / "clusters.h5", everyone);
    hdf5::Group group = file.create_group("model");
    clustered->save_sample(group);
  }
  const auto single = VortexCase().model(alone())->clustered(clusters);
  const auto expected = contract::by_particle(*single->rows(), rate_of(*single, initial_state_of(*single)), 2);
  Teuchos::ParameterList list = VortexCase().list();
  list.remove("particles");
  for (const bool together : {true, false}) {
    const auto communicator = together ? everyone : alone();
    const hdf5::File file = hdf5::File::read(folder / "clusters.h5", communicator);
    const auto restored = Registry<Model>::restore(list, {communicator}, file.group("model"));
    EXPECT_EQ(restored->rows()->getGlobalNumElements(), rows.size());
    const VectorView f = rate_of(*restored, initial_state_of(*restored));
    for (const auto& [particle, values] : contract::by_particle(*restored->rows(), f, 2)) {
      EXPECT_EQ(values, expected.at(particle)) << "particle " << particle;
    }
    for (LocalIndex j = local_size(*restored->rows()); j < local_size(*restored->sources()); ++j) {
      const GlobalIndex id = restored->sources()->getGlobalElement(j);
      EXPECT_TRUE(id >= static_cast<GlobalIndex>(VortexCase().cloud().x.size()) ||
                  std::binary_search(rows.begin(), rows.end(), id))
          << "source " << id << " is neither a cluster nor a row";
    }
  }
}

TEST(VortexClusters, ThatDoNotFitAreRefused) {
  const auto model = VortexCase().model();
  const SourceClusters right = squares(VortexCase().cloud(), 0.8);
  const auto message = [&](auto spoil) -> std::string {
    SourceClusters clusters = right;
    spoil(clusters);
    try {
      model->clustered(clusters);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(message([](SourceClusters&) {}), "nothing was thrown");
  EXPECT_NE(message([](SourceClusters& c) { c.row_clusters[5] = 99999; }).find("a row sums over cluster 99999"),
            std::string::npos);
  EXPECT_NE(message([](SourceClusters& c) { c.row_weights.pop_back(); }).find("differ in length"), std::string::npos);
  EXPECT_NE(message([](SourceClusters& c) { c.members[0] = 4000; }).find("particle 4000 is no source"),
            std::string::npos);
  EXPECT_NE(message([](SourceClusters& c) { std::swap(c.rows[0], c.rows[1]); }).find("rows are in no order"),
            std::string::npos);
  EXPECT_NE(message([](SourceClusters& c) { c.rows.back() = 4000; }).find("particle 4000 is no row"),
            std::string::npos);
}

}  // namespace
}  // namespace kiln
