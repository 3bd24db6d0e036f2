#include <fmt/format.h>

#include <Tpetra_Map.hpp>
#include <cmath>
#include <random>

#include "bench/Figures.hpp"
#include "bench/Program.hpp"
#include "framework/driver/RunSpecification.hpp"
#include "framework/input/Input.hpp"
#include "framework/observers/Probes.hpp"
#include "framework/queries/PointBlock.hpp"
#include "framework/registry/Registry.hpp"
#include "framework/report/Provenance.hpp"
#include "framework/time/TimeLoop.hpp"

namespace kiln::bench {
namespace {

/// Powers and speeds around the input's own, at random.
ParameterPoints points_around(const Parameters& parameters, std::size_t count) {
  ParameterPoints points{{"heat_source.power", "heat_source.velocity.x"}, {}};
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> factor(0.9, 1.1);
  for (std::size_t point = 0; point < count; ++point) {
    points.values.push_back(
        {parameters.get(points.names[0]) * factor(generator), parameters.get(points.names[1]) * factor(generator)});
  }
  return points;
}

/// Keeps the probes of every step.
class Keep final : public StepListener {
 public:
  Keep(Method::Reader reader, std::size_t width, std::vector<double>& values)
      : reader_(std::move(reader)), told_("probes", width), values_(values) {}
  void observe(const Moment& moment) override {
    reader_(moment.x, told_);
    values_.insert(values_.end(), told_.data(), told_.data() + told_.extent(0));
  }

 private:
  Method::Reader reader_;
  VectorView told_;
  std::vector<double>& values_;
};

class Queries {
 public:
  Queries(const Teuchos::ParameterList& input, const Teuchos::RCP<const Communicator>& communicator)
      : span_(TimeSpan::of(input)),
        method_(Registry<Method>::create(input.sublist("method"), Method::Context{input, communicator})),
        scheme_(Registry<TimeScheme>::create(input.sublist("time").sublist("scheme"),
                                             TimeScheme::Context{*method_, span_.step})),
        x_("x", local_size(*method_->coordinates())) {
    for (const Probe& probe : find_probes(input.sublist("output").sublist("probes"), *method_)) {
      places_.push_back(probe.particle.local);
    }
  }

  Parameters& parameters() { return method_->parameters(); }
  int steps() const { return span_.last_step; }

  /// One after the other, with all that is set up kept. Probes by step by point.
  std::vector<double> alone(const ParameterPoints& points) {
    std::vector<double> values;
    Keep keep(method_->reader(places_), places_.size(), values);
    for (std::size_t point = 0; point < points.count(); ++point) {
      points.set(point, method_->parameters());
      method_->forget();
      method_->initial(x_);
      scheme_->start(x_, 0.0);
      run_time_loop(*method_, *scheme_, x_, span_, {&keep});
    }
    return values;
  }

  std::vector<double> together(const ParameterPoints& points, std::size_t width) {
    const std::size_t row = places_.size(), history = (span_.last_step + 1) * row;
    std::vector<double> values(points.count() * history);
    std::unique_ptr<PointBlock> block;
    for (std::size_t first = 0; first < points.count(); first += width) {
      const std::size_t count = std::min(width, points.count() - first);
      if (first == 0 || count != width) {
        block = dynamic_cast<AdvancesTogether&>(*method_).point_block({count, *scheme_, span_.step, places_});
      }
      const MatrixView told("probes", count, row);
      const auto keep = [&](int step) {
        block->tell(told);
        for (std::size_t point = 0; point < count; ++point) {
          for (std::size_t k = 0; k < row; ++k) values[(first + point) * history + step * row + k] = told(point, k);
        }
      };
      block->start(points.part(first, count));
      keep(0);
      for (int step = 1; step <= span_.last_step; ++step) {
        block->advance(step, step * span_.step);
        keep(step);
      }
    }
    return values;
  }

 private:
  TimeSpan span_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<TimeScheme> scheme_;
  VectorView x_;
  std::vector<LocalIndex> places_;
};

double largest_relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] / b[i] - 1.0));
  return largest;
}

std::vector<Figure> measure(Queries& queries, std::size_t a_run, int runs) {
  const ParameterPoints all = points_around(queries.parameters(), a_run * (runs + 1));
  const std::vector<std::size_t> widths = {8, 16, 32};
  std::vector<std::function<void()>> works;
  std::size_t run = 0;
  std::vector<double> alone;
  double difference = 0.0;
  works.emplace_back([&] { alone = queries.alone(all.part(run * a_run, a_run)); });
  for (const std::size_t width : widths) {
    works.emplace_back([&, width] {
      const std::vector<double> together = queries.together(all.part(run * a_run, a_run), width);
      difference = std::max(difference, largest_relative_difference(together, alone));
    });
  }
  works.emplace_back([&] { ++run; });
  const auto seconds = interleaved(runs, works);
  const double scale = 1e6 / (static_cast<double>(a_run) * queries.steps());
  std::vector<Figure> figures = {{"queries.together", "", ratios(seconds[0], seconds[2])},
                                 {"queries.largest_relative_difference", "", {difference}},
                                 {"queries.one_by_one_us_per_step", "us", scaled(seconds[0], scale)}};
  for (std::size_t w = 0; w < widths.size(); ++w) {
    figures.push_back({fmt::format("queries.together_{}_us_per_step", widths[w]), "us", scaled(seconds[w + 1], scale)});
  }
  return figures;
}

}  // namespace
}  // namespace kiln::bench

int main(int argc, char** argv) {
  using namespace kiln::bench;
  const Words usage = {"bench_queries queries INPUT METHOD REDUCTION QUERIES FOLDER: writes FOLDER/queries.json"};
  return program(argc, argv, usage, {6}, [](const Words& words, const auto& communicator) {
    constexpr int runs = 5;
    const std::vector<std::string> overrides = {"method.type=" + words[2], "method.file=" + words[3]};
    const kiln::Input input = kiln::Input::read(words[1], overrides, kiln::run_specification(), *communicator);
    Queries queries(input.list(), communicator);
    write(words[5] + "/" + words[0] + ".json", measure(queries, std::stoul(words[4]) / runs, runs),
          kiln::provenance(*communicator));
  });
}
