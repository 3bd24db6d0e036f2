#include "framework/method/Divergence.hpp"

#include <fmt/format.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace kiln {
namespace {

template <class View>
auto on_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// A NaN's sign means nothing to a reader.
std::string number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.6g}", value); }

std::optional<ConstPositionView> positions_of(const Model& model) {
  try {
    return model.positions();
  } catch (const NotOffered&) {
    return std::nullopt;
  }
}

}  // namespace

bool all_finite(const Communicator& communicator, ConstVectorView a, ConstVectorView b) {
  // x − x is 0 for finite x alone, NaN for the rest; −ffast-math would break this, and Kiln does not use it.
  double sum = 0.0, total = 0.0;
  const LocalIndex size_a = static_cast<LocalIndex>(a.extent(0));
  const LocalIndex size_b = static_cast<LocalIndex>(b.extent(0));
  Kokkos::parallel_reduce(
      "kiln::method::all_finite", RangePolicy(0, size_a > size_b ? size_a : size_b),
      KOKKOS_LAMBDA(const LocalIndex i, double& differences) {
        if (i < size_a) differences += a(i) - a(i);
        if (i < size_b) differences += b(i) - b(i);
      },
      sum);
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, 1, &sum, &total);
  return total == 0.0;
}

DivergenceError divergence(const Model& model, const std::string& what, double time, ConstVectorView u,
                           ConstVectorView f, ConstVectorView measure) {
  const Map& rows = *model.rows();
  const Communicator& communicator = *rows.getComm();
  const std::vector<Field> fields = model.fields();
  const LocalIndex components = static_cast<LocalIndex>(fields.size());
  const auto state = on_host(u);
  const auto rate = on_host(f);
  const auto size = on_host(measure);

  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  // The first entry without a finite value on this rank, and the one with the largest measure.
  std::pair<GlobalIndex, LocalIndex> broken{none, 0}, largest{none, 0};
  double most = -1.0;
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(state.extent(0)); ++i) {
    const GlobalIndex particle = rows.getGlobalElement(i / components);
    if (!std::isfinite(state(i)) || !std::isfinite(rate(i)) || !std::isfinite(size(i))) {
      if (particle < broken.first) broken = {particle, i};
    } else if (std::abs(size(i)) > most) {
      most = std::abs(size(i));
      largest = {particle, i};
    }
  }
  GlobalIndex particle = none;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &broken.first, &particle);
  LocalIndex entry = broken.second;
  if (particle == none) {
    double most_of_all = -1.0;
    Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &most, &most_of_all);
    const GlobalIndex candidate = most == most_of_all ? largest.first : none;
    Teuchos::reduceAll(communicator, Teuchos::REDUCE_MIN, 1, &candidate, &particle);
    entry = largest.second;
  }
  if (particle == none) return DivergenceError(what, time);

  const std::optional<ConstPositionView> positions = positions_of(model);
  std::array<double, 6> mine{}, owners{};
  if (rows.isNodeGlobalElement(particle)) {
    mine = {0, 0, 0, state(entry), rate(entry), static_cast<double>(entry % components)};
    if (positions) {
      const auto here =
          on_host(Kokkos::subview(*positions, static_cast<std::size_t>(rows.getLocalElement(particle)), Kokkos::ALL));
      for (int axis = 0; axis < 3; ++axis) mine[axis] = here(axis);
    }
  }
  // One rank owns the particle; the others add zeros.
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), owners.data());
  DivergenceError::Place place{particle, std::nullopt};
  if (positions) place.position = {owners[0], owners[1], owners[2]};
  const Field& field = fields[static_cast<std::size_t>(owners[5])];
  return DivergenceError(fmt::format("{}: {} = {} {}, its rate = {} {}/s", what, field.name, number(owners[3]),
                                     field.unit, number(owners[4]), field.unit),
                         time, place);
}

}  // namespace kiln
