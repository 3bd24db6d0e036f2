#include "rom/clustering/Partition.hpp"

#include <algorithm>
#include <cmath>

namespace kiln {
namespace {

/// Steps of the power iteration: enough to tell along which direction points lie apart.
constexpr int power_steps = 20;
constexpr int lloyd_steps = 50;

struct Part {
  std::vector<std::size_t> members;  ///< ascending
  std::size_t group;
  std::vector<double> mean = {};
  double scatter = 0.0;
};

class Cutting {
 public:
  Cutting(const Points& points, const std::vector<double>& weights) : points_(points), weights_(weights) {}

  Part part(std::vector<std::size_t> members, std::size_t group) const {
    Part result{std::move(members), group, std::vector<double>(points_.dimension, 0.0)};
    measure(result);
    return result;
  }

  void measure(Part& part) const {
    double weight = 0.0;
    std::fill(part.mean.begin(), part.mean.end(), 0.0);
    for (const std::size_t m : part.members) {
      weight += weights_[m];
      for (std::size_t k = 0; k < points_.dimension; ++k) part.mean[k] += weights_[m] * points_[m][k];
    }
    for (double& value : part.mean) value /= weight;
    part.scatter = 0.0;
    for (const std::size_t m : part.members) part.scatter += weights_[m] * distance(m, part);
  }

  double distance(std::size_t point, const Part& part) const {
    return squared_distance(points_[point], part.mean.data(), points_.dimension);
  }

  /// The members' places along the part's principal direction, from its mean.
  std::vector<double> projections(const Part& part) const {
    const std::size_t dimension = points_.dimension;
    std::vector<double> direction(dimension), next(dimension), places(part.members.size());
    std::size_t farthest = part.members.front();
    double most = 0.0;
    for (const std::size_t m : part.members) {
      const double moment = weights_[m] * distance(m, part);
      if (moment > most * (1.0 + clustering_tie)) {
        most = moment;
        farthest = m;
      }
    }
    for (std::size_t k = 0; k < dimension; ++k) direction[k] = points_[farthest][k] - part.mean[k];
    for (int step = 0; step <= power_steps; ++step) {
      normalise(direction);
      std::fill(next.begin(), next.end(), 0.0);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t m = part.members[i];
        double place = 0.0;
        for (std::size_t k = 0; k < dimension; ++k) place += (points_[m][k] - part.mean[k]) * direction[k];
        places[i] = place;
        for (std::size_t k = 0; k < dimension; ++k) next[k] += weights_[m] * place * (points_[m][k] - part.mean[k]);
      }
      if (step < power_steps) direction.swap(next);
    }
    return places;
  }

  /// Cuts off what lies beyond the best place along the principal direction. Empty where all members coincide.
  std::vector<std::size_t> cut(const Part& part) const {
    const std::vector<double> places = projections(part);
    const auto [low, high] = std::minmax_element(places.begin(), places.end());
    const double apart = clustering_tie * (*high - *low);
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&places](std::size_t a, std::size_t b) { return std::pair(places[a], a) < std::pair(places[b], b); });
    double total = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      total += weights_[part.members[i]];
      sum += weights_[part.members[i]] * places[i];
    }
    double best = 0.0, weight = 0.0, first_sum = 0.0;
    std::size_t at = 0;
    for (std::size_t n = 0; n + 1 < order.size(); ++n) {
      weight += weights_[part.members[order[n]]];
      first_sum += weights_[part.members[order[n]]] * places[order[n]];
      if (!(places[order[n + 1]] - places[order[n]] > apart)) continue;
      const double between = first_sum / weight - (sum - first_sum) / (total - weight);
      const double gain = weight * (total - weight) / total * between * between;
      if (gain > best * (1.0 + clustering_tie)) {
        best = gain;
        at = n + 1;
      }
    }
    std::vector<std::size_t> beyond;
    if (at == 0) return beyond;
    for (std::size_t n = at; n < order.size(); ++n) beyond.push_back(part.members[order[n]]);
    std::sort(beyond.begin(), beyond.end());
    return beyond;
  }

  /// Points to the nearest mean of their group. Returns whether any moved.
  bool move(std::vector<Part>& parts) const {
    std::vector<std::vector<std::size_t>> members(parts.size());
    bool moved = false;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (const std::size_t m : parts[p].members) {
        std::size_t nearest = p;
        double least = distance(m, parts[p]);
        for (std::size_t q = 0; q < parts.size(); ++q) {
          if (parts[q].group != parts[p].group) continue;
          const double other = distance(m, parts[q]);
          if (other < least * (1.0 - clustering_tie)) {
            least = other;
            nearest = q;
          }
        }
        members[nearest].push_back(m);
        moved = moved || nearest != p;
      }
    }
    if (!moved) return false;
    std::vector<Part> kept;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (members[p].empty()) continue;
      std::sort(members[p].begin(), members[p].end());
      kept.push_back(part(std::move(members[p]), parts[p].group));
    }
    parts = std::move(kept);
    return true;
  }

 private:
  static void normalise(std::vector<double>& direction) {
    double square = 0.0;
    std::size_t largest = 0;
    for (std::size_t k = 0; k < direction.size(); ++k) {
      square += direction[k] * direction[k];
      if (std::abs(direction[k]) > std::abs(direction[largest]) * (1.0 + clustering_tie)) largest = k;
    }
    if (square == 0.0) return;
    // A direction and its opposite are one: which of them decides ties.
    const double scale = (direction[largest] < 0.0 ? -1.0 : 1.0) / std::sqrt(square);
    for (double& value : direction) value *= scale;
  }

  const Points& points_;
  const std::vector<double>& weights_;
};

/// Scatter below this is that of round-off.
double negligible_scatter(const Points& points, const std::vector<double>& weights) {
  const std::vector<double> origin(points.dimension, 0.0);
  double sum = 0.0;
  for (std::size_t m = 0; m < weights.size(); ++m) {
    sum += weights[m] * squared_distance(points[m], origin.data(), points.dimension);
  }
  return clustering_tie * clustering_tie * sum;
}

}  // namespace

std::vector<std::vector<std::size_t>> partition(const Points& points, const std::vector<double>& weights,
                                                const std::vector<std::vector<std::size_t>>& groups,
                                                std::size_t parts) {
  const Cutting cutting(points, weights);
  std::vector<Part> found;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    if (groups[group].empty()) continue;
    std::vector<std::size_t> members = groups[group];
    std::sort(members.begin(), members.end());
    found.push_back(cutting.part(std::move(members), group));
  }
  const double negligible = negligible_scatter(points, weights);
  while (found.size() < parts) {
    std::size_t widest = found.size();
    double most = negligible;
    for (std::size_t p = 0; p < found.size(); ++p) {
      if (found[p].scatter > most * (1.0 + clustering_tie)) {
        most = found[p].scatter;
        widest = p;
      }
    }
    if (widest == found.size()) break;
    std::vector<std::size_t> beyond = cutting.cut(found[widest]);
    if (beyond.empty()) break;
    std::vector<std::size_t> rest;
    std::set_difference(found[widest].members.begin(), found[widest].members.end(), beyond.begin(), beyond.end(),
                        std::back_inserter(rest));
    const std::size_t group = found[widest].group;
    found[widest] = cutting.part(std::move(rest), group);
    found.push_back(cutting.part(std::move(beyond), group));
  }
  for (int step = 0; step < lloyd_steps && cutting.move(found); ++step) continue;

  std::sort(found.begin(), found.end(),
            [](const Part& a, const Part& b) { return a.members.front() < b.members.front(); });
  std::vector<std::vector<std::size_t>> result;
  for (Part& part : found) result.push_back(std::move(part.members));
  return result;
}

}  // namespace kiln
