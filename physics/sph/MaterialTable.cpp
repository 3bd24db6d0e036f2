#include "physics/sph/MaterialTable.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "framework/base/Error.hpp"
#include "physics/sph/Material.hpp"

namespace kiln {
namespace {

constexpr int most_intervals = 1000000;

void check(double value, const char* property, const char* unit, double u, const std::string& path) {
  if (std::isfinite(value) && value > 0.0) return;
  throw InputError(path, fmt::format("the {} at {} K is {}", property, u, value),
                   fmt::format("a finite value in {} above 0 throughout the table", unit));
}

std::vector<double> tabulated(const Material& material, double from, double to, double step, const std::string& path) {
  if (!std::isfinite(from) || !std::isfinite(to) || !(to > from)) {
    throw InputError(path, fmt::format("the table of properties goes from {} K to {} K", from, to), "a rising range");
  }
  const double intervals = TableRange{from, to, step}.intervals();
  if (!(step > 0.0) || !(intervals <= most_intervals)) {
    throw InputError(path, fmt::format("the table of properties has steps of {} K", step),
                     fmt::format("a step above 0 that gives at most {} entries", most_intervals));
  }
  std::vector<double> values;
  for (int i = 0; i <= static_cast<int>(intervals); ++i) {
    const double u = from + i * step;
    const MaterialPoint<double> point = material.at(u);
    check(point.conductivity, "conductivity", "W/(m K)", u, path);
    check(point.specific_heat, "specific heat", "J/(kg K)", u, path);
    check(point.density, "density", "kg/m^3", u, path);
    values.insert(values.end(), {point.conductivity, point.specific_heat, point.density});
  }
  return values;
}

}  // namespace

TableRange TableRange::of(const Teuchos::ParameterList& model) {
  const Teuchos::ParameterList& table = model.sublist("table");
  return {table.get<double>("from"), table.get<double>("to"), table.get<double>("step")};
}

double TableRange::intervals() const { return std::ceil((to - from) / step * (1.0 - 1e-12)); }

MaterialTable::MaterialTable(const Material& material, double from, double to, double step, const std::string& path)
    : MaterialTable(from, step, tabulated(material, from, to, step, path)) {}

MaterialTable::MaterialTable(double from, double step, const std::vector<double>& values)
    : MaterialLookup(from, step, static_cast<LocalIndex>(values.size() / 3) - 1) {
  if (values.size() % 3 != 0 || intervals_ < 1) {
    throw std::invalid_argument(fmt::format("{} numbers do not make a material table", values.size()));
  }
  const Kokkos::View<MaterialRow*, Device> rows("material table", values.size() / 3);
  const auto host = Kokkos::create_mirror_view(rows);
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    host(i) = {};
    for (std::size_t k = 0; k < 3; ++k) {
      host(i).values[k] = values[3 * i + k];
      if (i + 1 < host.extent(0)) host(i).differences[k] = values[3 * i + 3 + k] - values[3 * i + k];
    }
  }
  Kokkos::deep_copy(rows, host);
  held_ = rows;
  rows_ = held_.data();
  const std::optional<MaterialPieces> pieces = MaterialPieces::of(values);
  if (!pieces) return;
  const Kokkos::View<MaterialPieces*, Device> held_pieces("pieces of a material table", 1);
  const auto host_pieces = Kokkos::create_mirror_view(held_pieces);
  host_pieces(0) = *pieces;
  Kokkos::deep_copy(held_pieces, host_pieces);
  held_pieces_ = held_pieces;
  pieces_ = held_pieces_.data();
}

std::vector<double> MaterialTable::values() const {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), held_);
  std::vector<double> values;
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    values.insert(values.end(), host(i).values, host(i).values + 3);
  }
  return values;
}

}  // namespace kiln
