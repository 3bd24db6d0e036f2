#include "rom/training/TimeWindows.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/Collectives.hpp"

namespace kiln {

Specification WindowSettings::specification() {
  Specification s;
  s.integer("count", "number of windows, of equal length").at_least(1).optional();
  s.integer("steps", "steps of each window, up to whole snapshots").at_least(1).optional();
  s.real("error", "largest error of a queried particle: windows are as few as keep below it with basis.rank modes each")
      .above(0)
      .below(1)
      .optional();
  s.check([](const Teuchos::ParameterList& list, std::vector<Problem>& problems) {
    int given = 0;
    for (const char* key : {"count", "steps", "error"}) given += list.isParameter(key) ? 1 : 0;
    if (given != 1) {
      problems.push_back({"", given == 0 ? "says nothing" : "says more than one thing", "count, steps or error", {}});
    }
  });
  return s;
}

WindowSettings WindowSettings::of(const Teuchos::ParameterList* list) {
  WindowSettings settings;
  if (list == nullptr) {
    settings.count = 1;
    return settings;
  }
  if (list->isParameter("count")) settings.count = list->get<int>("count");
  if (list->isParameter("steps")) settings.steps = list->get<int>("steps");
  if (list->isParameter("error")) settings.error = list->get<double>("error");
  return settings;
}

WindowCosts::WindowCosts(const Snapshots& snapshots, const Communicator& communicator)
    : products_(dense::gram(snapshots.matrix())) {
  sum_over_ranks(communicator, products_.data(), products_.size());
  for (int n = 1; n <= this->snapshots(); ++n) largest_ = std::max(largest_, std::sqrt(product(n, n)));
}

double WindowCosts::projection_error(int begin, int end, int rank) const {
  const int count = end - begin;
  if (count <= rank || largest_ == 0.0) return 0.0;
  const MatrixView increments("kiln::rom::products of increments", count, count);
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const int n = begin + 1 + i, m = begin + 1 + j;
      increments(i, j) = product(n, m) - product(n, begin) - product(begin, m) + product(begin, begin);
    }
  }
  const std::vector<double> squares = dense::symmetric_eigen(increments);
  double missed = 0.0;
  for (int k = rank; k < count; ++k) missed += std::max(0.0, squares[k]);
  return std::sqrt(missed / count) / largest_;
}

std::vector<int> windows_within(const WindowCosts& costs, int rank, double error) {
  const int last = costs.snapshots();
  std::vector<int> ends;
  int begin = 0;
  while (begin < last) {
    // The error grows with a window's length: bisection between a length that fits and one that does not.
    int fits = std::min(rank, last - begin), fails = last - begin + 1;
    while (fails - fits > 1) {
      const int guess = (fits + fails) / 2;
      (costs.projection_error(begin, begin + guess, rank) <= error ? fits : fails) = guess;
    }
    begin += fits;
    ends.push_back(begin);
  }
  return ends;
}

}  // namespace kiln
