#pragma once

#include "physics/sph/Lanes.hpp"

#ifdef KILN_LANES
namespace kiln {

/// MaterialLookup::at for eight temperatures, where the table has pieces.
inline MaterialPoint<Lanes> properties_at(const MaterialLookup& table, const MaterialPieces& pieces, const Lanes& u) {
  const Lanes place = table.place_of(u, all_lanes(table.last_place()));
  const Lanes fraction = place - whole_part(place);
  LaneBits piece = {};
  // A comparison's lanes are 0 and −1.
  for (int k = 1; k < MaterialPieces::most; ++k) piece -= place >= pieces.starts[k];
  const Lanes x = place - picked(pieces.starts, piece);
  const auto property = [&](int k) {
    return MaterialLookup::of_piece(picked(pieces.values[k], piece), picked(pieces.firsts[k], piece),
                                    picked(pieces.seconds[k], piece), x, fraction);
  };
  return {property(0), property(1), property(2)};
}

/// MaterialLookup::at for eight temperatures.
inline MaterialPoint<Lanes> properties_at(const MaterialLookup& table, const Lanes& u) {
  if (table.pieces() != nullptr) return properties_at(table, *table.pieces(), u);
  double fraction[lane_count];
  int interval[lane_count];
#pragma omp simd
  for (int lane = 0; lane < lane_count; ++lane) interval[lane] = table.interval(u[lane], fraction[lane]);
  const MaterialRow* rows = table.rows();
  HalfLanes records[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) {
    const MaterialRow& row = rows[interval[lane]];
    HalfLanes values, differences;
    __builtin_memcpy(&values, row.values, sizeof values);
    __builtin_memcpy(&differences, row.differences, sizeof differences);
    records[lane] = values + fraction[lane] * differences;
  }
  const FieldLanes fields = field_lanes(records);
  return {fields.first, fields.second, fields.third};
}

/// thermal_state for eight particles.
struct ThermalLanes {
  Lanes temperature;
  Lanes resistivity;
  Lanes volume;
  Lanes specific_heat;
};
inline ThermalLanes thermal_lanes(const MaterialLookup& table, const Lanes& temperature, const Lanes& masses) {
  const MaterialPoint<Lanes> point = properties_at(table, temperature);
  const Lanes both = 1.0 / (point.conductivity * point.density);
  return {temperature, both * point.density, masses * (both * point.conductivity), point.specific_heat};
}

/// Writes eight whole states one after the other, transposed in registers.
inline void store_states(ThermalState<double>* states, const ThermalLanes& lanes) {
  const Lanes even = __builtin_shufflevector(lanes.temperature, lanes.resistivity, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes odd = __builtin_shufflevector(lanes.temperature, lanes.resistivity, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes further_even = __builtin_shufflevector(lanes.volume, lanes.specific_heat, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes further_odd = __builtin_shufflevector(lanes.volume, lanes.specific_heat, 1, 9, 3, 11, 5, 13, 7, 15);
  // States 0 and 4, 1 and 5, 2 and 6, 3 and 7.
  const Lanes whole[4] = {__builtin_shufflevector(even, further_even, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(odd, further_odd, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(even, further_even, 2, 3, 10, 11, 6, 7, 14, 15),
                          __builtin_shufflevector(odd, further_odd, 2, 3, 10, 11, 6, 7, 14, 15)};
  for (int k = 0; k < 4; ++k) {
    const HalfLanes lower = __builtin_shufflevector(whole[k], whole[k], 0, 1, 2, 3);
    const HalfLanes upper = __builtin_shufflevector(whole[k], whole[k], 4, 5, 6, 7);
    __builtin_memcpy(&states[k], &lower, sizeof lower);
    __builtin_memcpy(&states[k + 4], &upper, sizeof upper);
  }
}

}  // namespace kiln
#endif
