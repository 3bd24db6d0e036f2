#include "physics/vortex/GaussianPatches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"
#include "framework/base/Pi.hpp"

namespace kiln {
namespace {

constexpr double most_nodes = 1e8;

/// Calls visit(x, y) at the grid's nodes within `cutoff` radii of a patch. Returns false, and visits none, where the
/// grid around the patches has too many nodes.
template <class Visit>
bool visit_nodes(const std::vector<GaussianPatch>& patches, double cutoff, double spacing, const Visit& visit) {
  double lower[2] = {patches[0].x, patches[0].y}, upper[2] = {patches[0].x, patches[0].y};
  for (const GaussianPatch& patch : patches) {
    const double reach = cutoff * patch.radius;
    lower[0] = std::min(lower[0], patch.x - reach);
    lower[1] = std::min(lower[1], patch.y - reach);
    upper[0] = std::max(upper[0], patch.x + reach);
    upper[1] = std::max(upper[1], patch.y + reach);
  }
  if (!((upper[0] - lower[0]) / spacing * ((upper[1] - lower[1]) / spacing) < most_nodes)) return false;
  // Node i lies at (i + 1/2) h.
  const auto first = [spacing](double bound) { return static_cast<long long>(std::floor(bound / spacing - 0.5)); };
  const auto last = [spacing](double bound) { return static_cast<long long>(std::ceil(bound / spacing - 0.5)); };
  const long long right = last(upper[0]), top = last(upper[1]);
  for (long long j = first(lower[1]); j <= top; ++j) {
    const double y = (static_cast<double>(j) + 0.5) * spacing;
    for (long long i = first(lower[0]); i <= right; ++i) {
      const double x = (static_cast<double>(i) + 0.5) * spacing;
      const bool inside = std::any_of(patches.begin(), patches.end(), [&](const GaussianPatch& patch) {
        const double reach = cutoff * patch.radius;
        return (x - patch.x) * (x - patch.x) + (y - patch.y) * (y - patch.y) <= reach * reach;
      });
      if (inside) visit(x, y);
    }
  }
  return true;
}

/// Particles on a grid; one more than wanted stands for a grid too fine to count.
long long number_on_grid(const std::vector<GaussianPatch>& patches, double cutoff, double spacing, long long wanted) {
  long long number = 0;
  return visit_nodes(patches, cutoff, spacing, [&number](double, double) { ++number; }) ? number : wanted + 1;
}

double spacing_for(const std::vector<GaussianPatch>& patches, double cutoff, long long wanted) {
  double area = 0.0;
  for (const GaussianPatch& patch : patches) area += pi * cutoff * cutoff * patch.radius * patch.radius;
  // Discs that overlap need a finer grid than their areas say.
  double fine = std::sqrt(area / static_cast<double>(wanted)), coarse = 2.0 * fine;
  while (number_on_grid(patches, cutoff, fine, wanted) < wanted) fine *= 0.5;
  while (number_on_grid(patches, cutoff, coarse, wanted) >= wanted) coarse *= 2.0;
  while (coarse - fine > 1e-12 * coarse) {
    const double middle = 0.5 * (fine + coarse);
    (number_on_grid(patches, cutoff, middle, wanted) < wanted ? coarse : fine) = middle;
  }
  return fine;
}

}  // namespace

void PatchGrid::add_entries(Specification& specification) {
  specification.real("spacing", "of the grid the particles stand on; or give count").unit("m").above(0).optional();
  specification.integer("count", "particles at least; the grid that gives them is found; or give spacing")
      .at_least(1)
      .at_most(10000000)
      .optional();
  specification.real("cutoff", "a patch ends at so many radii, where its vorticity is exp(-cutoff^2) of its centre's")
      .above(0)
      .at_most(6)
      .defaults_to(3.0);
  specification.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    if (list.isParameter("spacing") == list.isParameter("count")) {
      problems.push_back({"spacing", list.isParameter("count") ? "stands beside count" : "is missing, and so is count",
                          "either spacing or count", ""});
    }
  });
}

PatchGrid::PatchGrid(const Teuchos::ParameterList& list) : path_(list.name()), cutoff_(list.get<double>("cutoff")) {
  if (list.isParameter("spacing")) spacing_ = list.get<double>("spacing");
  if (list.isParameter("count")) count_ = list.get<int>("count");
  if ((spacing_ > 0.0) == (count_ > 0)) {
    throw InputError(path_ + ".spacing", fmt::format("spacing is {} and count {}", spacing_, count_),
                     "one of the two above 0");
  }
}

VortexCloud PatchGrid::cloud(const std::vector<GaussianPatch>& patches) const {
  if (patches.empty()) throw InputError(path_ + ".patches", "there is no patch", "at least 1");
  for (const GaussianPatch& patch : patches) {
    if (std::isfinite(patch.x) && std::isfinite(patch.y) && std::isfinite(patch.circulation) &&
        std::isfinite(patch.radius) && patch.radius > 0.0) {
      continue;
    }
    throw InputError(path_ + ".patches",
                     fmt::format("a patch at ({:.6g}, {:.6g}) m has the radius {:.6g} m and the circulation {:.6g} "
                                 "m^2/s",
                                 patch.x, patch.y, patch.radius, patch.circulation),
                     "finite numbers and a radius above 0");
  }
  const double spacing = spacing_ > 0.0 ? spacing_ : spacing_for(patches, cutoff_, count_);
  VortexCloud cloud;
  const bool done = visit_nodes(patches, cutoff_, spacing, [&](double x, double y) {
    double vorticity = 0.0;
    for (const GaussianPatch& patch : patches) {
      const double squares = patch.radius * patch.radius;
      const double r2 = (x - patch.x) * (x - patch.x) + (y - patch.y) * (y - patch.y);
      vorticity += patch.circulation / (pi * squares) * std::exp(-r2 / squares);
    }
    cloud.add(x, y, vorticity * spacing * spacing);
  });
  if (!done) {
    throw InputError(path_ + ".spacing",
                     fmt::format("a grid of spacing {:.6g} m around the patches is too fine", spacing),
                     fmt::format("at most {:.0e} nodes", most_nodes));
  }
  return cloud;
}

}  // namespace kiln
