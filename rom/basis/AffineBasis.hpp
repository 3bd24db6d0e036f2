#pragma once

#include "rom/basis/TrialSpace.hpp"

namespace kiln {

/// The affine trial space u = u_ref + Φ û (Eq. 13).
class AffineBasis : public TrialSpace {
 public:
  /// reference: u_ref of the particles; modes: their rows of Φ. Throws std::logic_error for sizes that differ.
  AffineBasis(VectorView reference, MatrixView modes);

  int size() const override { return static_cast<int>(modes_.extent(1)); }
  void state(ConstVectorView coordinates, VectorView u) const override;
  ConstMatrixView tangent(ConstVectorView coordinates) const override;
  bool affine() const override { return true; }

 private:
  ConstVectorView reference_;
  ConstMatrixView modes_;
};

}  // namespace kiln
