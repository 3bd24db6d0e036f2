#pragma once

#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "framework/registry/Registry.hpp"
#include "physics/sph/HeatModel.hpp"
#include "unit_tests/physics/ModelCase.hpp"

namespace kiln {

/// The input of a small `sph heat` case, as the checker would hand it to the model.
struct HeatCase {
  std::array<double, 3> origin = {0.0, 0.0, 0.0};
  std::array<double, 3> size = {0.48e-3, 0.36e-3, 0.24e-3};
  std::array<int, 3> count = {12, 9, 6};
  std::string placement = "nodes";
  std::string kernel = "cubic spline";
  std::string boundary = "as printed";
  double smoothing_length = 1.5;
  double initial_temperature = 293.15;
  Teuchos::ParameterList material = Teuchos::ParameterList("model.material").set("type", std::string("316L"));
  Teuchos::ParameterList heat_source = beam(40.0);
  Teuchos::ParameterList table = table_block();

  static Teuchos::ParameterList beam(double power) {
    Teuchos::ParameterList list("model.heat_source");
    list.set("type", std::string("gaussian beam")).set("power", power).set("width", 60e-6);
    list.set("start", reals({0.1e-3, 0.15e-3})).set("velocity", reals({0.5, 0.1}));
    return list.set("normalisation", std::string("standard"));
  }
  static Teuchos::ParameterList table_block() {
    const TableRange usual;
    Teuchos::ParameterList list("model.table");
    return list.set("from", usual.from).set("to", usual.to).set("step", usual.step);
  }
  static Teuchos::ParameterList no_source() {
    return Teuchos::ParameterList("model.heat_source").set("type", std::string("none"));
  }
  static Teuchos::ParameterList constant_material(double conductivity, double specific_heat, double density) {
    Teuchos::ParameterList list("model.material");
    list.set("type", std::string("constant")).set("conductivity", conductivity);
    return list.set("specific_heat", specific_heat).set("density", density);
  }

  Teuchos::ParameterList list() const {
    Teuchos::ParameterList result("model");
    result.set("type", std::string("sph heat"));
    Teuchos::ParameterList& particles = result.sublist("particles").setName("model.particles");
    particles.set("type", std::string("lattice")).set("placement", placement);
    particles.set("origin", reals({origin[0], origin[1], origin[2]})).set("size", reals({size[0], size[1], size[2]}));
    particles.set("count", Teuchos::Array<int>(std::vector<int>(count.begin(), count.end())));
    result.set("smoothing_length", smoothing_length).set("boundary", boundary);
    result.sublist("kernel").setName("model.kernel").set("type", kernel);
    result.set("material", material).set("heat_source", heat_source).set("table", table);
    result.set("initial_temperature", initial_temperature);
    return result;
  }

  std::unique_ptr<HeatModel> model(const Teuchos::RCP<const Communicator>& communicator) const {
    return std::make_unique<HeatModel>(list(), Model::Context{communicator});
  }
  std::unique_ptr<HeatModel> model() const { return model(Tpetra::getDefaultComm()); }
};

/// A rough temperature of a particle between 300 K and 3500 K that depends on its id only: every phase, no pattern.
inline double rough_temperature(GlobalIndex id) {
  const double x = std::sin(12.9898 * static_cast<double>(id) + 4.1414) * 43758.5453;
  return 300.0 + 3200.0 * (x - std::floor(x));
}

inline VectorView rough_state(const Model& model) {
  VectorView u("u", model.sources()->getNodeNumElements());
  for (std::size_t i = 0; i < u.extent(0); ++i) {
    u(i) = rough_temperature(model.sources()->getGlobalElement(static_cast<LocalIndex>(i)));
  }
  return u;
}

inline VectorView rate_of(const Model& model, const VectorView& u, double time) {
  VectorView f("f", model.rows()->getNodeNumElements());
  model.rate(u, time, f);
  return f;
}

}  // namespace kiln
