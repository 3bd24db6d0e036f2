#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "framework/base/Loop.hpp"
#include "framework/model/PointRates.hpp"
#include "physics/sph/HeatModel.hpp"
#include "physics/sph/PairRows.hpp"
#include "physics/sph/ThermalLanes.hpp"

namespace kiln {

#ifdef KILN_LANES
namespace {

// Labels made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string absorbed_label = "kiln::sph::absorbed power of points";
const std::string states_label = "kiln::sph::thermal states of points";
const std::string sums_label = "kiln::sph::pair sums of points";
const std::string rates_label = "kiln::sph::rates of points";

}  // namespace

/// Eight points are a vector; its lanes are the same particle in eight states. What a pair reads of its neighbour are
/// whole vectors, so that nothing is gathered, and neighbours and weights serve eight points.
class HeatModel::AtPoints final : public PointRates {
 public:
  AtPoints(HeatModel& model, const ParameterPoints& points)
      : model_(model),
        points_(points),
        groups_((points.count() + lane_count - 1) / lane_count),
        states_(Kokkos::view_alloc(Kokkos::WithoutInitializing, "thermal states of points"),
                groups_ * static_cast<std::size_t>(model.source_count())),
        specific_heats_("specific heats of points", groups_ * static_cast<std::size_t>(model.row_count())),
        held_fluxes_("heat flux of points", points.count(), model.heated_.extent(0)),
        fluxes_(uncounted(held_fluxes_)),
        positions_(model.heated_positions_.data(), model.heated_.extent(0)),
        absorbed_("absorbed power of points", groups_ * static_cast<std::size_t>(model.row_count())),
        pair_fluxes_("pair sums of points", groups_ * static_cast<std::size_t>(model.row_count())),
        summed_(groups_, false) {
    AtPoints::take(points);
  }

  void take(const ParameterPoints& points) override {
    points_ = points;
    absorbed_time_ = std::numeric_limits<double>::quiet_NaN();
    summed_.assign(groups_, false);
    if (points_.count() == 0) return;
    points_.set(0, model_.parameters_);
    source_ = model_.heat_source_->at_points(points_.count(),
                                             [this](std::size_t point) { points_.set(point, model_.parameters_); });
  }

  void rates(ConstMatrixView u, double time, const PointMask& wanted, MatrixView f) override {
    if (u.extent(0) != points_.count() || f.extent(0) != points_.count() || !u.span_is_contiguous()) {
      throw std::invalid_argument("HeatModel: arrays of another number of points, or with gaps");
    }
    model_.check("rates", u.extent(1), f.extent(1));
    if (!(time == absorbed_time_) && points_.count() > 0) update_absorbed(time);
    for (std::size_t group = 0; group < groups_; ++group) {
      if (!any_wanted(wanted, group * lane_count, width(group))) continue;
      // As LastState has it: the first residual of a step is asked for where the step before ended.
      if (!summed_[group] || !are_of(group, borrowed(u))) {
        summed_[group] = false;
        update_states(group, u);
        sum_pairs(group);
        summed_[group] = true;
      }
      form_rates(group, f);
    }
  }

 private:
  std::size_t width(std::size_t group) const {
    return std::min<std::size_t>(lane_count, points_.count() - group * lane_count);
  }

  /// What a point absorbs does not depend on its state: one evaluation serves all iterations of a step.
  void update_absorbed(double time) {
    const auto heated = borrowed(model_.heated_);
    const auto number = static_cast<LocalIndex>(heated.extent(0));
    absorbed_time_ = std::numeric_limits<double>::quiet_NaN();
    source_->flux(time, positions_, fluxes_);
    const auto absorbed = borrowed(absorbed_);
    const auto fluxes = borrowed(fluxes_);
    const auto areas = borrowed(model_.domain_.areas);
    const std::size_t rows = model_.row_count(), points = points_.count();
    loop(
        absorbed_label, number, KOKKOS_LAMBDA(LocalIndex h) {
          const LocalIndex row = heated(h);
          std::size_t group = 0;
          for (; (group + 1) * lane_count <= points; ++group) {
            store_lanes(&absorbed(group * rows + row, 0), lanes_at(&fluxes(group * lane_count, h)) * areas(row));
          }
          for (std::size_t lane = 0; lane < points - group * lane_count; ++lane) {
            absorbed(group * rows + row, lane) = fluxes(group * lane_count + lane, h) * areas(row);
          }
        });
    absorbed_time_ = time;
  }

  /// Zero where the group has no point.
  static Lanes temperatures(const Borrowed<ConstMatrixView>& u, std::size_t first_point, std::size_t points,
                            LocalIndex source) {
    if (points == lane_count) return lanes_at(&u(first_point, source));
    Lanes temperature = {};
    for (std::size_t lane = 0; lane < points; ++lane) temperature[lane] = u(first_point + lane, source);
    return temperature;
  }

  /// Whether a group's states are those of these temperatures.
  bool are_of(std::size_t group, const Borrowed<ConstMatrixView>& u) const {
    const std::size_t first = group * static_cast<std::size_t>(model_.source_count());
    LaneBits differing = {};
    for (LocalIndex j = 0; j < model_.source_count(); ++j) {
      differing |= differing_bits(temperatures(u, group * lane_count, width(group), j), states_(first + j).temperature);
    }
    return !any_bit(differing);
  }

  void update_states(std::size_t group, const ConstMatrixView& u) {
    const auto states = borrowed(states_);
    const auto specific_heats = borrowed(specific_heats_);
    const auto masses = borrowed(model_.domain_.masses);
    const MaterialLookup table = model_.table_;
    const std::size_t first_point = group * lane_count, points = width(group);
    const std::size_t rows = model_.row_count(), first = group * static_cast<std::size_t>(model_.source_count());
    const auto temperature = borrowed(u);
    loop(
        states_label, model_.source_count(), KOKKOS_LAMBDA(LocalIndex j) {
          const ThermalLanes state =
              thermal_lanes(table, temperatures(temperature, first_point, points, j), all_lanes(masses(j)));
          states(first + j) = {state.temperature, state.resistivity, state.volume};
          if (static_cast<std::size_t>(j) < rows) {
            store_lanes(&specific_heats(group * rows + j, 0), state.specific_heat);
          }
        });
  }

  void sum_pairs(std::size_t group) {
    const PairRows pairs(model_.domain_);
    const auto states = borrowed(states_);
    const auto fluxes = borrowed(pair_fluxes_);
    const std::size_t rows = model_.row_count(), first = group * static_cast<std::size_t>(model_.source_count());
    loop(
        sums_label, model_.row_count(), KOKKOS_LAMBDA(LocalIndex i) {
          store_lanes(&fluxes(group * rows + i, 0),
                      pair_sum_of_points(&states(first), states(first + i), pairs.sources_of(i), pairs.weights_of(i),
                                         pairs.count(i)));
        });
  }

  void form_rates(std::size_t group, const MatrixView& of_rows) {
    const auto f = borrowed(of_rows);
    const auto states = borrowed(states_);
    const auto specific_heats = borrowed(specific_heats_);
    const auto absorbed = borrowed(absorbed_);
    const auto fluxes = borrowed(pair_fluxes_);
    const auto masses = borrowed(model_.domain_.masses);
    const std::size_t first_point = group * lane_count, points = width(group);
    const std::size_t rows = model_.row_count(), first = group * static_cast<std::size_t>(model_.source_count());
    loop(
        rates_label, model_.row_count(), KOKKOS_LAMBDA(LocalIndex i) {
          const Lanes rate =
              heat_rate(states(first + i).volume, lanes_at(&specific_heats(group * rows + i, 0)),
                        lanes_at(&fluxes(group * rows + i, 0)), masses(i), lanes_at(&absorbed(group * rows + i, 0)));
          if (points == lane_count) {
            store_lanes(&f(first_point, i), rate);
          } else {
            for (std::size_t lane = 0; lane < points; ++lane) f(first_point + lane, i) = rate[lane];
          }
        });
  }

  using LaneView = Kokkos::View<double* [lane_count], Kokkos::LayoutRight, Device>;

  HeatModel& model_;
  ParameterPoints points_;
  std::size_t groups_;                        ///< of eight points each, the last one perhaps of fewer
  Kokkos::View<StateLanes*, Device> states_;  ///< group by group: of the sources
  LaneView specific_heats_;                   ///< group by group: of the rows
  std::unique_ptr<PointFluxes> source_;
  MatrixView held_fluxes_;       ///< at the heated rows, of each point
  MatrixView fluxes_;            ///< the same, handed on without an owner to count
  ConstPositionView positions_;  ///< likewise
  LaneView absorbed_;            ///< as specific_heats_, at absorbed_time_
  LaneView pair_fluxes_;         ///< as specific_heats_, of states_
  std::vector<char> summed_;     ///< of each group: whether its states and pair sums were made
  double absorbed_time_ = std::numeric_limits<double>::quiet_NaN();
};

std::unique_ptr<PointRates> HeatModel::at_points(const ParameterPoints& points) {
  return std::make_unique<AtPoints>(*this, points);
}
#else
std::unique_ptr<PointRates> HeatModel::at_points(const ParameterPoints& points) {
  return one_after_the_other(*this, points);
}
#endif

}  // namespace kiln
