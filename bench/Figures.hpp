#pragma once

#include <time.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Figures of ./dev bench and how they are taken.
namespace kiln::bench {

/// Values of one figure, a run each.
struct Figure {
  std::string name;
  std::string unit;
  std::vector<double> runs;
};

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// `{name, value, unit, low, high, runs}` of each: the median, the least and the most of all runs, and their number.
inline void write(const std::string& path, const std::vector<Figure>& figures, const nlohmann::json& machine) {
  nlohmann::json list = nlohmann::json::array();
  for (const Figure& figure : figures) {
    list.push_back({{"name", figure.name},
                    {"value", median(figure.runs)},
                    {"unit", figure.unit},
                    {"low", *std::min_element(figure.runs.begin(), figure.runs.end())},
                    {"high", *std::max_element(figure.runs.begin(), figure.runs.end())},
                    {"runs", figure.runs.size()}});
  }
  std::ofstream(path) << nlohmann::json({{"machine", machine}, {"figures", list}}).dump(1) << '\n';
}

/// Seconds that this thread has run: what other processes take of a shared machine does not count.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of each work in each run, one after the other within a run, so that what disturbs one disturbs all. The
/// first run is not counted.
inline std::vector<std::vector<double>> interleaved(int runs, const std::vector<std::function<void()>>& works) {
  std::vector<std::vector<double>> seconds(works.size());
  for (int run = -1; run < runs; ++run) {
    for (std::size_t w = 0; w < works.size(); ++w) {
      const double start = thread_seconds();
      works[w]();
      if (run >= 0) seconds[w].push_back(thread_seconds() - start);
    }
  }
  return seconds;
}

/// a / b of each run.
inline std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result;
  for (std::size_t run = 0; run < a.size(); ++run) result.push_back(a[run] / b[run]);
  return result;
}

inline std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace kiln::bench
