#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <limits>
#include <map>

#include "framework/base/Collectives.hpp"
#include "framework/base/Error.hpp"
#include "physics/sph/DomainParts.hpp"
#include "physics/sph/HeatModel.hpp"

namespace kiln {
namespace {

/// What the members of clusters bring into their means, wherever they lie. The same on every rank.
class Members {
 public:
  /// Throws InputError for a particle that the domain does not have. Collective.
  Members(const HeatDomain& domain, std::vector<GlobalIndex> ids) : ids_(std::move(ids)) {
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    if (ids_.empty()) return;
    const HostDomain from(domain);
    constexpr double unknown = -std::numeric_limits<double>::infinity();
    std::vector<double> mine(ids_.size() * width, unknown);
    values_.resize(mine.size());
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const LocalIndex place = domain.sources->getLocalElement(ids_[i]);
      if (place == Teuchos::OrdinalTraits<LocalIndex>::invalid()) continue;
      for (int axis = 0; axis < 3; ++axis) mine[i * width + axis] = from.positions(place, axis);
      mine[i * width + 3] = from.masses(place);
    }
    // Ranks that know a particle agree about it.
    Teuchos::reduceAll(*domain.rows->getComm(), Teuchos::REDUCE_MAX, static_cast<int>(mine.size()), mine.data(),
                       values_.data());
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (values_[i * width + 3] != unknown) continue;
      throw InputError("", fmt::format("particle {} is in a cluster, but not in the model", ids_[i]),
                       "clusters of the model's particles");
    }
  }

  void add(GlobalIndex id, double share, Point& position, double& mass) const {
    const std::size_t place = std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin();
    for (int axis = 0; axis < 3; ++axis) position[axis] += share * values_[place * width + axis];
    mass += share * values_[place * width + 3];
  }

 private:
  static constexpr std::size_t width = 4;
  std::vector<GlobalIndex> ids_;  ///< ascending
  std::vector<double> values_;    ///< x, y, z and mass of each
};

/// The clusters that some rows, given by their places among clusters.rows, use, by their ids as sources.
std::map<GlobalIndex, std::size_t> used_clusters(const SourceClusters& clusters, const std::vector<std::size_t>& rows,
                                                 GlobalIndex particles) {
  std::map<GlobalIndex, std::size_t> used;
  for (const std::size_t row : rows) {
    for (std::size_t pair = clusters.row_offsets[row]; pair < clusters.row_offsets[row + 1]; ++pair) {
      const std::size_t cluster = clusters.row_clusters[pair];
      used.emplace(clusters.source_id(cluster, particles), cluster);
    }
  }
  return used;
}

}  // namespace

HeatDomain clustered_domain(const HeatDomain& domain, const SourceClusters& clusters) {
  const HeatDomain sample = sampled_domain(domain, clusters.rows);
  const HostDomain local(sample);
  const GlobalIndex particles = domain.rows->getMaxAllGlobalIndex() + 1;
  DomainParts parts;
  parts.rows = parts.sources = local.rows;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < parts.rows.size(); ++i) {
    const auto place = std::lower_bound(clusters.rows.begin(), clusters.rows.end(), parts.rows[i]);
    rows.push_back(static_cast<std::size_t>(place - clusters.rows.begin()));
    parts.positions.push_back({local.positions(i, 0), local.positions(i, 1), local.positions(i, 2)});
    parts.masses.push_back(local.masses(i));
    parts.areas.push_back(local.areas(i));
  }
  const Members members(domain, clusters.members);
  std::map<GlobalIndex, LocalIndex> places;
  for (std::size_t i = 0; i < parts.rows.size(); ++i) places[parts.rows[i]] = static_cast<LocalIndex>(i);
  for (const auto& [id, cluster] : used_clusters(clusters, rows, particles)) {
    if (!places.emplace(id, static_cast<LocalIndex>(parts.sources.size())).second) continue;
    Point position{};
    double mass = 0.0;
    for (std::size_t m = clusters.member_offsets[cluster]; m < clusters.member_offsets[cluster + 1]; ++m) {
      members.add(clusters.members[m], clusters.shares[m], position, mass);
    }
    parts.sources.push_back(id);
    parts.positions.push_back(position);
    parts.masses.push_back(mass);
  }
  for (const std::size_t row : rows) {
    for (std::size_t pair = clusters.row_offsets[row]; pair < clusters.row_offsets[row + 1]; ++pair) {
      const LocalIndex source = places.at(clusters.source_id(clusters.row_clusters[pair], particles));
      parts.neighbours.push_back(source);
      parts.weights.push_back(clusters.row_weights[pair] / parts.masses[source]);
    }
    parts.offsets.push_back(parts.neighbours.size());
  }
  return assembled(parts, domain.rows->getComm());
}

std::unique_ptr<Model> HeatModel::clustered(const SourceClusters& clusters) const {
  return on(clustered_domain(domain_, clusters));
}

PairWeights HeatModel::pair_weights(const std::vector<GlobalIndex>& rows) const {
  const HeatDomain sample = sampled_domain(domain_, rows);
  const HostDomain local(sample);
  std::vector<GlobalIndex> local_counts, local_sources;
  std::vector<double> local_weights;
  for (std::size_t i = 0; i < local.rows.size(); ++i) {
    local_counts.push_back(static_cast<GlobalIndex>(local.offsets(i + 1) - local.offsets(i)));
    for (std::size_t pair = local.offsets(i); pair < local.offsets(i + 1); ++pair) {
      const LocalIndex source = local.neighbours(pair);
      local_sources.push_back(local.sources[source]);
      local_weights.push_back(local.weights(pair) * local.masses(source));
    }
  }
  const Communicator& communicator = *domain_.rows->getComm();
  const auto ids = concatenated(communicator, local.rows);
  const auto counts = concatenated(communicator, local_counts);
  const auto sources = concatenated(communicator, local_sources);
  const auto weights = concatenated(communicator, local_weights);
  std::vector<std::ptrdiff_t> starts{0};
  for (const GlobalIndex count : counts) starts.push_back(starts.back() + static_cast<std::ptrdiff_t>(count));

  PairWeights pairs;
  pairs.offsets.push_back(0);
  for (const std::size_t row : ascending(ids)) {
    pairs.rows.push_back(ids[row]);
    pairs.sources.insert(pairs.sources.end(), sources.begin() + starts[row], sources.begin() + starts[row + 1]);
    pairs.weights.insert(pairs.weights.end(), weights.begin() + starts[row], weights.begin() + starts[row + 1]);
    pairs.offsets.push_back(pairs.sources.size());
  }
  return pairs;
}

}  // namespace kiln
