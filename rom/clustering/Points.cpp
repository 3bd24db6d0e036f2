#include "rom/clustering/Points.hpp"

namespace kiln {

double squared_distance(const double* a, const double* b, std::size_t dimension) {
  double sum = 0.0;
  for (std::size_t k = 0; k < dimension; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

Points trajectories(const SourceMotion& motion, const std::vector<std::size_t>& particles) {
  const std::size_t components = motion.components, moments = motion.states.extent(1);
  Points points{components * moments, {}};
  points.values.reserve(particles.size() * points.dimension);
  for (const std::size_t particle : particles) {
    for (std::size_t moment = 0; moment < moments; ++moment) {
      for (std::size_t c = 0; c < components; ++c) {
        points.values.push_back(motion.states(particle * components + c, moment));
      }
    }
  }
  return points;
}

}  // namespace kiln
