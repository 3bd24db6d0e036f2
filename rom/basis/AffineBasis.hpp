#pragma once

#include "rom/basis/TrialSpace.hpp"

namespace kiln {

/// The affine trial space of time window w (Eq. 13):
///
///     u = u_ref + Σ_{v<w} Φ_v û_v + Φ_w û_w
///
/// The sum over earlier windows is the state in which they ended: with û_w = 0 the window begins exactly there,
/// whatever the bases are. It is formed once and kept while the earlier coordinates stay as they are. Where the window
/// before is at hand, it is that one's state, which adds a single window to a sum that is known already.
class AffineBasis : public TrialSpace {
 public:
  /// reference: u_ref of the particles; modes: their rows of [Φ_0 … Φ_w]; first: the column at which Φ_w begins;
  /// previous: the space of window w − 1 told for the same particles, if there is one. Throws std::logic_error for
  /// sizes that do not fit.
  AffineBasis(ConstVectorView reference, ConstMatrixView modes, int first = 0,
              std::shared_ptr<const TrialSpace> previous = nullptr);

  int first() const override { return first_; }
  int size() const override { return static_cast<int>(tangent_.extent(1)); }
  void state(ConstVectorView x, VectorView u) const override;
  ConstMatrixView tangent(ConstVectorView) const override { return tangent_; }
  bool affine() const override { return true; }
  std::unique_ptr<TrialSpace> restricted(const std::vector<LocalIndex>& particles, int components) const override;

 private:
  void begin_at(ConstVectorView earlier) const;

  ConstVectorView reference_;
  ConstMatrixView modes_, tangent_;
  int first_;
  std::shared_ptr<const TrialSpace> previous_;
  VectorView earlier_;  ///< the coordinates of earlier windows that beginning_ belongs to
  VectorView beginning_;
};

}  // namespace kiln
