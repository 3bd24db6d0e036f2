#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/Memory.hpp"
#include "framework/registry/Registry.hpp"
#include "physics/sph/Particles.hpp"

namespace kiln {
namespace {

constexpr const char* axis_name = "xyz";

/// A rectangular lattice (report §4.1): nodes on the faces of a box, or centres of the cells that fill it. Ids run
/// through x fastest, then y, then z. The layer of largest z is heated.
class Lattice final : public Particles {
 public:
  static Specification specification() {
    Specification specification;
    specification.reals("origin", "corner of the box with the smallest x, y, z").unit("m").length(3);
    specification.reals("size", "edges of the box").unit("m").length(3).above(0);
    specification.integers("count", "particles along x, y, z").length(3).at_least(1);
    specification
        .choice("placement",
                "nodes: on the faces and between; cells: centres of equal cells, what mirrored boundaries need",
                {"nodes", "cells"})
        .defaults_to("nodes");
    specification.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
      const auto count = list.get<Teuchos::Array<int>>("count");
      if (list.isParameter("placement") && list.get<std::string>("placement") != "nodes") return;
      for (int axis = 0; axis < 3; ++axis) {
        if (count[axis] < 2) {
          problems.push_back({"count", fmt::format("{} node along {}", count[axis], axis_name[axis]),
                              "at least 2: nodes lie on both faces; or placement: cells", ""});
        }
      }
    });
    return specification;
  }

  Lattice(const Teuchos::ParameterList& list, const Context&) : cells_(list.get<std::string>("placement") == "cells") {
    const auto origin = list.get<Teuchos::Array<double>>("origin");
    const auto size = list.get<Teuchos::Array<double>>("size");
    const auto count = list.get<Teuchos::Array<int>>("count");
    const int fewest = cells_ ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(origin[axis])) {
        throw InputError(list.name() + ".origin", fmt::format("{} is {}", axis_name[axis], origin[axis]),
                         "a finite coordinate in m");
      }
      if (!std::isfinite(size[axis]) || size[axis] <= 0.0) {
        throw InputError(list.name() + ".size", fmt::format("the edge along {} is {}", axis_name[axis], size[axis]),
                         "a finite length in m above 0");
      }
      if (count[axis] < fewest) {
        throw InputError(list.name() + ".count", fmt::format("{} particles along {}", count[axis], axis_name[axis]),
                         fmt::format("at least {}", fewest));
      }
      origin_[axis] = origin[axis];
      size_[axis] = size[axis];
      count_[axis] = count[axis];
      spacing_[axis] = size[axis] / (cells_ ? count[axis] : count[axis] - 1);
    }
    const double number = static_cast<double>(count[0]) * count[1] * count[2];
    constexpr double bytes = sizeof(Point) + 2 * sizeof(double);
    if (number > std::numeric_limits<LocalIndex>::max() || number * bytes > machine_memory()) {
      throw InputError(list.name() + ".count", fmt::format("{:.6g} particles in all", number),
                       fmt::format("at most {:.6g}: what this machine's memory holds",
                                   std::min<double>(std::numeric_limits<LocalIndex>::max(), machine_memory() / bytes)));
    }
  }

  ParticleCloud cloud() const override {
    ParticleCloud cloud;
    const auto number = static_cast<std::size_t>(count_[0]) * count_[1] * count_[2];
    cloud.positions.reserve(number);
    cloud.heated_areas.reserve(number);
    for (int k = 0; k < count_[2]; ++k) {
      for (int j = 0; j < count_[1]; ++j) {
        for (int i = 0; i < count_[0]; ++i) {
          cloud.positions.push_back({coordinate(0, i), coordinate(1, j), coordinate(2, k)});
          cloud.heated_areas.push_back(k == count_[2] - 1 ? share(0, i) * share(1, j) * spacing_[0] * spacing_[1]
                                                          : 0.0);
        }
      }
    }
    cloud.volumes.assign(number, size_[0] * size_[1] * size_[2] / static_cast<double>(number));
    cloud.spacing = *std::max_element(spacing_.begin(), spacing_.end());
    if (cells_) {
      cloud.faces = Box{origin_, {origin_[0] + size_[0], origin_[1] + size_[1], origin_[2] + size_[2]}};
    }
    return cloud;
  }

 private:
  double coordinate(int axis, int i) const {
    return cells_ ? origin_[axis] + size_[axis] * (i + 0.5) / count_[axis]
                  : origin_[axis] + size_[axis] * i / (count_[axis] - 1);
  }
  /// Part of Δ that lies inside the box around a particle: a half at a node on a face.
  double share(int axis, int i) const { return !cells_ && (i == 0 || i == count_[axis] - 1) ? 0.5 : 1.0; }

  bool cells_;
  Point origin_;
  Point size_;
  std::array<int, 3> count_;
  Point spacing_;
};

KILN_REGISTER(Particles, Lattice, "lattice", "rectangular lattice: nodes on the faces of a box, or centres of cells");

}  // namespace
}  // namespace kiln
