#pragma once

#include "framework/base/LinearAlgebra.hpp"
#include "physics/sph/MaterialTable.hpp"

namespace kiln {

/// Properties of a material over temperature. Models read it once, into a MaterialTable.
class Material {
 public:
  struct Context {
    Teuchos::RCP<const Communicator> communicator;
  };
  static constexpr const char* category = "material";

  virtual ~Material() = default;
  /// Properties at temperature u in K.
  virtual MaterialPoint<double> at(double u) const = 0;
};

}  // namespace kiln
