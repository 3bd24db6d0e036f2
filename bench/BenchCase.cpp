#include "bench/BenchCase.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <Teuchos_ParameterList.hpp>
#include <cmath>
#include <random>

namespace kiln::bench {
namespace {

constexpr double spacing = 40e-6;

Teuchos::Array<double> reals(const std::vector<double>& values) { return Teuchos::Array<double>(values); }

Teuchos::ParameterList model_list() {
  Teuchos::ParameterList list("model");
  list.set("type", std::string("sph heat")).set("smoothing_length", 1.5).set("boundary", std::string("as printed"));
  list.sublist("kernel").setName("model.kernel").set("type", std::string("cubic spline"));
  list.sublist("material").setName("model.material").set("type", std::string("316L"));
  const TableRange table;
  list.sublist("table").setName("model.table").set("from", table.from).set("to", table.to).set("step", table.step);
  list.set("initial_temperature", 293.15);
  Teuchos::ParameterList& beam = list.sublist("heat_source").setName("model.heat_source");
  beam.set("type", std::string("gaussian beam")).set("power", 40.0).set("width", 50e-6);
  beam.set("start", reals({0.0, 0.0})).set("velocity", reals({0.5, 0.0}));
  beam.set("normalisation", std::string("standard"));
  return list;
}

}  // namespace

std::unique_ptr<HeatModel> BenchCase::lattice(const Teuchos::RCP<const Communicator>& communicator) const {
  Teuchos::ParameterList list = model_list();
  Teuchos::ParameterList& particles = list.sublist("particles").setName("model.particles");
  particles.set("type", std::string("lattice")).set("placement", std::string("nodes"));
  particles.set("origin", reals({0.0, 0.0, 0.0}));
  particles.set("size",
                reals({spacing * (count[0] - 1), spacing * 1.01 * (count[1] - 1), spacing * 0.952 * (count[2] - 1)}));
  particles.set("count", Teuchos::Array<int>(std::vector<int>(count.begin(), count.end())));
  return std::make_unique<HeatModel>(list, Model::Context{communicator});
}

std::unique_ptr<HeatModel> BenchCase::cloud(const Teuchos::RCP<const Communicator>& communicator,
                                            const std::string& file) const {
  if (communicator->getRank() == 0) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> jitter(-0.2 * spacing, 0.2 * spacing);
    auto csv = fmt::output_file(file);
    csv.print("x,y,z\n");
    for (int k = 0; k < count[2]; ++k) {
      for (int j = 0; j < count[1]; ++j) {
        for (int i = 0; i < count[0]; ++i) {
          csv.print("{:.17g},{:.17g},{:.17g}\n", i * spacing + jitter(generator),
                    j * 1.01 * spacing + jitter(generator), k * 0.952 * spacing + jitter(generator));
        }
      }
    }
  }
  communicator->barrier();
  Teuchos::ParameterList list = model_list();
  Teuchos::ParameterList& particles = list.sublist("particles").setName("model.particles");
  particles.set("type", std::string("file")).set("path", file).set("spacing", 1.01 * spacing);
  particles.set("volume", std::pow(spacing, 3) * count[0] * count[1] * count[2]);
  return std::make_unique<HeatModel>(list, Model::Context{communicator});
}

VectorView weld_state(const Model& model) {
  const auto positions = model.positions();
  VectorView u("u", positions.extent(0));
  for (std::size_t j = 0; j < u.extent(0); ++j) {
    const double across = positions(j, 1) - 1e-3;
    const double along = positions(j, 0) - 2e-3;
    const double spot = std::exp(-(along * along + across * across) / 2e-8);
    const double trace = along < 0.0 ? std::exp(-across * across / 8e-8) : 0.0;
    u(j) = 293.15 + 2200.0 * spot + 500.0 * trace + 0.1 * std::sin(1e6 * (across + along));
  }
  return u;
}

}  // namespace kiln::bench
