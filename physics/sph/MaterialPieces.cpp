#include "physics/sph/MaterialPieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiln {
namespace {

/// How far a polynomial may be from a row, in parts of the row: what rounding makes of a formula.
constexpr double round_off = 8.0 * std::numeric_limits<double>::epsilon();

struct Polynomial {
  double value, first, second;

  double at(double x) const { return value + x * (first + x * second); }
};

class Rows {
 public:
  explicit Rows(const std::vector<double>& values) : values_(values) {}

  std::size_t count() const { return values_.size() / 3; }
  double at(std::size_t row, std::size_t property) const { return values_[3 * row + property]; }

  /// Through the rows `first`, `last` and one in the middle (Newton's divided differences).
  Polynomial through(std::size_t first, std::size_t last, std::size_t property) const {
    const double value = at(first, property), length = static_cast<double>(last - first);
    const double slope = (at(last, property) - value) / length;
    if (last - first < 2) return {value, slope, 0.0};
    const std::size_t middle = first + (last - first) / 2;
    const double half = static_cast<double>(middle - first);
    const double second = (slope - (at(middle, property) - value) / half) / (length - half);
    return {value, slope - second * length, second};
  }

  bool one_piece(std::size_t first, std::size_t last) const {
    for (std::size_t property = 0; property < 3; ++property) {
      const Polynomial polynomial = through(first, last, property);
      for (std::size_t row = first; row <= last; ++row) {
        const double expected = at(row, property);
        if (!(std::abs(polynomial.at(static_cast<double>(row - first)) - expected) <= round_off * std::abs(expected)))
          return false;
      }
    }
    return true;
  }

  /// The last row of the longest piece that begins at a row before the last one: found by doubling, then by halving.
  std::size_t end_of_piece(std::size_t first) const {
    std::size_t good = first + 1, step = 1;
    while (good + step < count() && one_piece(first, good + step)) {
      good += step;
      step *= 2;
    }
    for (; step > 0; step /= 2) {
      if (good + step < count() && one_piece(first, good + step)) good += step;
    }
    return good;
  }

 private:
  const std::vector<double>& values_;
};

}  // namespace

std::optional<MaterialPieces> MaterialPieces::of(const std::vector<double>& values) {
  const Rows rows(values);
  MaterialPieces pieces{};
  std::fill_n(pieces.starts, most, std::numeric_limits<double>::infinity());
  std::size_t first = 0;
  for (int piece = 0; piece < most; ++piece) {
    const bool is_last = first + 1 == rows.count();
    const std::size_t last = is_last ? first : rows.end_of_piece(first);
    pieces.starts[piece] = static_cast<double>(first);
    for (std::size_t property = 0; property < 3; ++property) {
      const Polynomial polynomial =
          is_last ? Polynomial{rows.at(first, property), 0.0, 0.0} : rows.through(first, last, property);
      pieces.values[property][piece] = polynomial.value;
      pieces.firsts[property][piece] = polynomial.first;
      pieces.seconds[property][piece] = polynomial.second;
    }
    if (is_last) return pieces;
    first = last;
  }
  return std::nullopt;
}

}  // namespace kiln
