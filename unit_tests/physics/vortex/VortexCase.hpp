#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "framework/registry/Registry.hpp"
#include "physics/vortex/VortexModel.hpp"
#include "unit_tests/physics/ModelCase.hpp"

namespace kiln {

/// The input of a small `vortex` case, as the checker would hand it to the model.
struct VortexCase {
  std::string kernel = "rosenhead-moore";
  double core_radius = 0.2;
  Teuchos::ParameterList particles = two_patches(0.21);
  Teuchos::ParameterList sum = Teuchos::ParameterList("model.sum").set("type", std::string("direct"));

  static Teuchos::ParameterList block(const std::string& type) {
    return Teuchos::ParameterList("model.particles").set("type", type);
  }
  /// Two unequal patches of opposite signs: about 250 particles for a spacing of 0.21 m.
  static Teuchos::ParameterList two_patches(double spacing) {
    Teuchos::ParameterList list = block("patches");
    Teuchos::ParameterList& patches = list.sublist("patches").setName("model.particles.patches");
    patches.sublist("0").set("centre", reals({-0.8, 0.1})).set("radius", 0.4).set("circulation", 2.0);
    patches.sublist("1").set("centre", reals({0.9, -0.2})).set("radius", 0.5).set("circulation", -1.2);
    return list.set("spacing", spacing).set("cutoff", 3.0);
  }
  static Teuchos::ParameterList pair(double left, double right, double separation) {
    return block("pair").set("circulations", reals({left, right})).set("separation", separation);
  }
  static Teuchos::ParameterList barnes_hut(double opening, int leaf = 8) {
    Teuchos::ParameterList list("model.sum");
    return list.set("type", std::string("barnes-hut")).set("opening", opening).set("leaf", leaf);
  }

  Teuchos::ParameterList list() const {
    Teuchos::ParameterList result("model");
    result.set("type", std::string("vortex"));
    result.set("particles", particles).set("sum", sum).set("circulation_scale", 1.0);
    result.sublist("kernel").setName("model.kernel").set("type", kernel).set("core_radius", core_radius);
    return result;
  }

  std::unique_ptr<VortexModel> model(const Teuchos::RCP<const Communicator>& communicator) const {
    return std::make_unique<VortexModel>(list(), Model::Context{communicator});
  }
  std::unique_ptr<VortexModel> model() const { return model(Tpetra::getDefaultComm()); }

  VortexCloud cloud() const { return Registry<Vortices>::create(particles, {Tpetra::getDefaultComm()})->cloud(); }
};

/// A distributed array of two components a particle, whole on every rank, by ids.
inline std::vector<double> gathered(const Map& rows, ConstVectorView values) {
  std::vector<double> mine(2 * rows.getGlobalNumElements(), 0.0), all(mine.size());
  for (LocalIndex i = 0; i < local_size(rows); ++i) {
    for (int c = 0; c < 2; ++c) mine[2 * rows.getGlobalElement(i) + c] = values(2 * i + c);
  }
  Teuchos::reduceAll(*rows.getComm(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}

inline VectorView initial_state_of(const Model& model) {
  const VectorView u("u", 2 * static_cast<std::size_t>(local_size(*model.sources())));
  model.initial_state(u);
  return u;
}

inline VectorView rate_of(const Model& model, ConstVectorView u) {
  const VectorView f("f", 2 * static_cast<std::size_t>(local_size(*model.rows())));
  model.rate(u, 0.0, f);
  return f;
}

}  // namespace kiln
