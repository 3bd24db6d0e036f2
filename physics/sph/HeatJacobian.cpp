#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/Loop.hpp"
#include "physics/sph/HeatModel.hpp"
#include "physics/sph/PairRows.hpp"

namespace kiln {
namespace {

// A label made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string diagonal_label = "kiln::sph::rate jacobian diagonal";

/// Pairs whose derivatives are held at once.
constexpr LocalIndex block_pairs = 64;

}  // namespace

void HeatModel::linearise(ConstVectorView u, double time) const {
  update_states(u);
  update_absorbed(time);
  if (slopes_.extent(0) != states_.extent(0)) {
    slopes_ = Kokkos::View<ThermalSlopes*, Device>("thermal slopes", states_.extent(0));
  }
  const auto states = states_;
  const auto slopes = slopes_;
  const auto masses = domain_.masses;
  const MaterialLookup table = table_;
  Kokkos::parallel_for(
      "kiln::sph::thermal slopes", RangePolicy(0, source_count()), KOKKOS_LAMBDA(LocalIndex j) {
        const MaterialPoint<double> slope = table.slopes(u(j));
        const ThermalState<double> state = states(j);
        slopes(j) = {-slope.conductivity * state.resistivity * state.resistivity,
                     -slope.density * state.volume * state.volume / masses(j), slope.specific_heat};
      });
}

void HeatModel::rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const {
  check("rate_jacobian_diagonal", u.extent(0), diagonal.extent(0));
  static_cast<void>(time);  // the absorbed power does not depend on the temperature when properties stand still
  update_states(u);
  layout_->sum(PairQuantity::conductance, states_, conductances_);
  const auto states = states_;
  const auto sums = conductances_;
  const auto masses = domain_.masses;
  loop(
      diagonal_label, row_count(), KOKKOS_LAMBDA(LocalIndex i) {
        const ThermalState<double>& own = states(i);
        diagonal(i) = 4.0 * own.volume * sums(i) / (masses(i) * own.specific_heat);
      });
}

/// One row of ∂f/∂u. With T_j = w V_j (u_i − u_j)/(a_i + a_j), a = 1/k, and f_i = (4 V_i Σ T_j + Q_i)/(m_i c_i):
///     ∂T_j/∂u_j = w (V_j′ (u_i − u_j) − V_j)/(a_i + a_j) − T_j a_j′/(a_i + a_j)
///     ∂T_j/∂u_i = w V_j/(a_i + a_j) − T_j a_i′/(a_i + a_j)
///     ∂f_i/∂u_i = (4 V_i′ Σ T_j + 4 V_i Σ ∂T_j/∂u_i)/(m_i c_i) − f_i c_i′/c_i.
struct HeatModel::JacobianRow {
  const ThermalState<double>* states;
  const ThermalSlopes* slopes;
  const LocalIndex* neighbours;
  const double* weights;
  LocalIndex row;
  double mass;
  double sum = 0.0;             ///< Σ T_j so far
  double derivative_sum = 0.0;  ///< Σ ∂T_j/∂u_i so far

  /// ∂f_i/∂u_j of pairs first … first + count − 1.
  KOKKOS_INLINE_FUNCTION void off_diagonal(LocalIndex first, LocalIndex count, double* entries) {
    const ThermalState<double> i = states[row];
    const double own_slope = slopes[row].resistivity;
    const double scale = 4.0 * i.volume / (mass * i.specific_heat);
    double terms = 0.0;
    double derivatives = 0.0;
#pragma omp simd reduction(+ : terms, derivatives)
    for (LocalIndex pair = 0; pair < count; ++pair) {
      const ThermalState<double>& j = states[neighbours[first + pair]];
      const ThermalSlopes& slope = slopes[neighbours[first + pair]];
      const double difference = i.temperature - j.temperature;
      const double inverse = 1.0 / (i.resistivity + j.resistivity);
      const double weight = weights[first + pair] * inverse;
      const double term = weight * j.volume * difference;
      terms += term;
      derivatives += weight * j.volume - term * own_slope * inverse;
      entries[pair] = scale * (weight * (slope.volume * difference - j.volume) - term * slope.resistivity * inverse);
    }
    sum += terms;
    derivative_sum += derivatives;
  }

  /// ∂f_i/∂u_i, once all pairs have been through off_diagonal.
  KOKKOS_INLINE_FUNCTION double diagonal(double absorbed) const {
    const ThermalState<double>& i = states[row];
    const ThermalSlopes& slope = slopes[row];
    const double capacity = mass * i.specific_heat;
    const double rate = (4.0 * i.volume * sum + absorbed) / capacity;
    return 4.0 * (slope.volume * sum + i.volume * derivative_sum) / capacity -
           rate * slope.specific_heat / i.specific_heat;
  }
};

/// What the kernels of ∂f/∂u read.
struct HeatModel::JacobianRows {
  PairRows pairs;
  ConstThermalStateView states;
  Kokkos::View<const ThermalSlopes*, Device> slopes;
  ConstVectorView masses;
  ConstVectorView absorbed;

  explicit JacobianRows(const HeatModel& model)
      : pairs(model.domain_),
        states(model.states_),
        slopes(model.slopes_),
        masses(model.domain_.masses),
        absorbed(model.absorbed_) {}

  KOKKOS_INLINE_FUNCTION JacobianRow row(LocalIndex i) const {
    return {states.data(), slopes.data(), pairs.sources_of(i), pairs.weights_of(i), i, masses(i)};
  }

  /// Calls visit(first pair, number of pairs, their ∂f_i/∂u_j) for a row's pairs, block by block, and returns
  /// ∂f_i/∂u_i.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION double visit_row(LocalIndex i, const Visit& visit) const {
    JacobianRow entries_of = row(i);
    double entries[block_pairs];
    const LocalIndex count = pairs.count(i);
    for (LocalIndex first = 0; first < count; first += block_pairs) {
      const LocalIndex number = count - first < block_pairs ? count - first : block_pairs;
      entries_of.off_diagonal(first, number, entries);
      visit(first, number, entries);
    }
    return entries_of.diagonal(absorbed(i));
  }
};

template <int Width>
void HeatModel::apply_columns(ConstMatrixView v, MatrixView product, int first_column) const {
  const int columns = std::min<int>(Width, static_cast<int>(v.extent(1)) - first_column);
  if (packed_.extent(0) != states_.extent(0)) {
    packed_ = PackedView(Kokkos::view_alloc(Kokkos::WithoutInitializing, "packed columns"), states_.extent(0));
  }
  // Row by row, so that a pair finds all its columns in one cache line.
  const auto packed = packed_;
  Kokkos::parallel_for(
      "kiln::sph::pack columns", RangePolicy(0, source_count()), KOKKOS_LAMBDA(LocalIndex j) {
        for (int c = 0; c < Width; ++c) packed(j, c) = c < columns ? v(j, first_column + c) : 0.0;
      });
  const JacobianRows rows(*this);
  Kokkos::parallel_for(
      "kiln::sph::apply rate jacobian", RangePolicy(0, row_count()), KOKKOS_LAMBDA(LocalIndex i) {
        double sums[Width] = {};
        const LocalIndex* sources = rows.pairs.sources_of(i);
        const double diagonal = rows.visit_row(i, [&](LocalIndex first, LocalIndex number, const double* entries) {
          for (LocalIndex pair = 0; pair < number; ++pair) {
            const double* source = &packed(sources[first + pair], 0);
#pragma omp simd
            for (int c = 0; c < Width; ++c) sums[c] += entries[pair] * source[c];
          }
        });
        for (int c = 0; c < columns; ++c) product(i, first_column + c) = sums[c] + diagonal * packed(i, c);
      });
}

void HeatModel::apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const {
  check("apply_rate_jacobian", u.extent(0), product.extent(0));
  check("apply_rate_jacobian", v.extent(0), product.extent(0));
  if (v.extent(1) != product.extent(1)) {
    throw std::invalid_argument("HeatModel::apply_rate_jacobian: v and product differ in their numbers of columns");
  }
  linearise(u, time);
  const int columns = static_cast<int>(v.extent(1));
  for (int first = 0; first < columns; first += block_width) {
    if (columns - first == 1) {
      apply_columns<1>(v, product, first);
    } else {
      apply_columns<block_width>(v, product, first);
    }
  }
}

void HeatModel::make_matrix() const {
  const auto offsets = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain_.pairs.offsets);
  const auto neighbours = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), domain_.pairs.neighbours);
  const auto number = static_cast<std::size_t>(row_count());
  const std::size_t pairs = neighbours.extent(0);
  Teuchos::ArrayRCP<std::size_t> starts(number + 1);
  Teuchos::ArrayRCP<LocalIndex> columns(pairs + number);
  matrix_slots_ = OffsetView("matrix slots of pairs", pairs);
  diagonal_slots_ = OffsetView("matrix slots of the diagonal", number);
  const auto slots = Kokkos::create_mirror_view(matrix_slots_);
  const auto diagonal = Kokkos::create_mirror_view(diagonal_slots_);
  std::vector<std::pair<LocalIndex, std::size_t>> row;
  for (std::size_t i = 0; i < number; ++i) {
    starts[i] = offsets(i) + i;
    row.assign(1, {static_cast<LocalIndex>(i), pairs});
    for (std::size_t pair = offsets(i); pair < offsets(i + 1); ++pair) row.emplace_back(neighbours(pair), pair);
    std::sort(row.begin(), row.end());
    for (std::size_t entry = 0; entry < row.size(); ++entry) {
      columns[starts[i] + entry] = row[entry].first;
      (row[entry].second == pairs ? diagonal(i) : slots(row[entry].second)) = starts[i] + entry;
    }
  }
  starts[number] = pairs + number;
  Kokkos::deep_copy(matrix_slots_, slots);
  Kokkos::deep_copy(diagonal_slots_, diagonal);
  matrix_ = Teuchos::rcp(new CrsMatrix(domain_.rows, domain_.sources, starts, columns,
                                       Teuchos::ArrayRCP<double>(static_cast<Teuchos::Ordinal>(pairs + number))));
  // A sampled model reads particles that are nobody's rows: in the matrix's domain each of them lies on one rank.
  const Teuchos::RCP<const Map> read = Tpetra::createOneToOne(domain_.sources);
  const bool whole = read->getGlobalNumElements() == domain_.rows->getGlobalNumElements();
  matrix_->expertStaticFillComplete(whole ? domain_.rows : read, domain_.rows);
}

Teuchos::RCP<const CrsMatrix> HeatModel::rate_jacobian_matrix(ConstVectorView u, double time) const {
  check("rate_jacobian_matrix", u.extent(0), domain_.areas.extent(0));
  linearise(u, time);
  if (matrix_.is_null()) make_matrix();
  const auto values = matrix_->getLocalMatrixDevice().values;
  const auto slots = matrix_slots_;
  const auto diagonal_slots = diagonal_slots_;
  const JacobianRows rows(*this);
  Kokkos::parallel_for(
      "kiln::sph::rate jacobian matrix", RangePolicy(0, row_count()), KOKKOS_LAMBDA(LocalIndex i) {
        const std::size_t begin = rows.pairs.first(i);
        const double diagonal = rows.visit_row(i, [&](LocalIndex first, LocalIndex number, const double* entries) {
          for (LocalIndex pair = 0; pair < number; ++pair) values(slots(begin + first + pair)) = entries[pair];
        });
        values(diagonal_slots(i)) = diagonal;
      });
  return matrix_;
}

}  // namespace kiln
