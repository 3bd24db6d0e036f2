#include "framework/observers/Probes.hpp"

#include <fmt/format.h>

#include <Teuchos_Array.hpp>
#include <Tpetra_Map.hpp>

#include "framework/base/Error.hpp"

namespace kiln {

std::vector<Probe> find_probes(const Teuchos::ParameterList& list, const Method& method) {
  const Teuchos::RCP<const Map> map = method.particles();
  const ConstPositionView positions = method.positions();
  const auto box = bounding_box(positions, *map->getComm());
  const Teuchos::ParameterList& points = list.sublist("points");
  std::vector<Probe> probes;
  std::vector<Problem> problems;
  for (int i = 0; points.isSublist(std::to_string(i)); ++i) {
    const Teuchos::ParameterList& entry = points.sublist(std::to_string(i));
    const auto& position = entry.get<Teuchos::Array<double>>("position");
    Probe probe{entry.get<std::string>("name"), {position[0], position[1], position[2]}, {}};
    probe.particle = method.nearest(probe.point);
    if (probe.particle.id < 0) {
      problems.push_back(
          {fmt::format("{}.points.{}.position", list.name(), i),
           fmt::format("probe '{}' at ({:.6g}, {:.6g}, {:.6g}) m: this method does not hold the particle "
                       "nearest to it",
                       probe.name, probe.point[0], probe.point[1], probe.point[2]),
           "a position among the probes and reduction.queries of the training, or on a particle that is "
           "held; or add it to reduction.queries and train again",
           ""});
      continue;
    }
    const double tolerance = list.isParameter("tolerance") ? list.get<double>("tolerance") : probe.particle.spacing;
    if (!(probe.particle.distance <= tolerance)) {
      problems.push_back(
          {fmt::format("{}.points.{}.position", list.name(), i),
           fmt::format("probe '{}' at ({:.6g}, {:.6g}, {:.6g}) m is outside: the nearest particle is {:.4g} m away",
                       probe.name, probe.point[0], probe.point[1], probe.point[2], probe.particle.distance),
           fmt::format("a point at most {:.4g} m from a particle; these lie in [{:.6g}, {:.6g}] × [{:.6g}, {:.6g}] × "
                       "[{:.6g}, {:.6g}] m",
                       tolerance, box[0][0], box[1][0], box[0][1], box[1][1], box[0][2], box[1][2]),
           ""});
    }
    probes.push_back(std::move(probe));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return probes;
}

}  // namespace kiln
