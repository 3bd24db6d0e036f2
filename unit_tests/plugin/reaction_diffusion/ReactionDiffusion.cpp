#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Map.hpp>
#include <cmath>
#include <vector>

#include "framework/model/Model.hpp"
#include "framework/plugin/Plugin.hpp"
#include "framework/registry/Registry.hpp"

KILN_PLUGIN();

namespace {

/// Fisher's equation on a rod with insulated ends,
///
///     ∂u/∂t = D ∂²u/∂x² + r u (1 − u),
///
/// by central differences between the centres of equal cells.
class ReactionDiffusion : public kiln::Model {
 public:
  static kiln::Specification specification() {
    kiln::Specification s;
    s.integer("cells", "cells along the rod").at_least(2);
    s.real("length", "length of the rod").unit("m").above(0);
    s.real("diffusivity", "D").unit("m^2/s").above(0);
    s.real("growth", "r").unit("1/s").above(0);
    s.real("front", "where the front is at the start").unit("m");
    return s;
  }

  ReactionDiffusion(const Teuchos::ParameterList& list, const Context& context)
      : cells_(list.get<int>("cells")),
        spacing_(list.get<double>("length") / cells_),
        diffusivity_(list.get<double>("diffusivity")),
        growth_(list.get<double>("growth")),
        front_(list.get<double>("front")) {
    // Parameters that a reduced run may change without being trained anew.
    parameters_.add("diffusivity", "m^2/s", &diffusivity_);
    parameters_.add("growth", "1/s", &growth_);

    // The cells are dealt out to the ranks in blocks; a rank also reads the cells on either side of its block.
    rows_ = Teuchos::rcp(new kiln::Map(cells_, 0, context.communicator));
    std::vector<kiln::GlobalIndex> sources;
    const kiln::LocalIndex rows = kiln::local_size(*rows_);
    for (kiln::LocalIndex i = 0; i < rows; ++i) sources.push_back(rows_->getGlobalElement(i));
    left_ = 0;
    right_ = rows - 1;
    if (rows > 0 && sources[0] > 0) {
      left_ = static_cast<kiln::LocalIndex>(sources.size());
      sources.push_back(sources[0] - 1);
    }
    if (rows > 0 && sources[rows - 1] < cells_ - 1) {
      right_ = static_cast<kiln::LocalIndex>(sources.size());
      sources.push_back(sources[rows - 1] + 1);
    }
    const auto total = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    sources_ = Teuchos::rcp(new kiln::Map(total, Teuchos::arrayViewFromVector(sources), 0, context.communicator));

    positions_ = kiln::PositionView("reaction diffusion: positions", sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) positions_(i, 0) = (sources[i] + 0.5) * spacing_;
  }

  Teuchos::RCP<const kiln::Map> rows() const override { return rows_; }
  Teuchos::RCP<const kiln::Map> sources() const override { return sources_; }
  std::vector<kiln::Field> fields() const override { return {{"density", "1"}}; }
  kiln::ConstPositionView positions() const override { return positions_; }

  /// The travelling front of Ablowitz and Zeppetella (1979), which keeps its form at the speed 5 √(D r / 6).
  void initial_state(kiln::VectorView u) const override {
    for (std::size_t i = 0; i < u.extent(0); ++i) {
      const double distance = (positions_(i, 0) - front_) * std::sqrt(growth_ / (6.0 * diffusivity_));
      u(i) = std::pow(1.0 + std::exp(distance), -2.0);
    }
  }

  void rate(kiln::ConstVectorView u, double, kiln::VectorView f) const override {
    const auto last = static_cast<kiln::LocalIndex>(f.extent(0)) - 1;
    const kiln::LocalIndex left = left_, right = right_;
    const double exchange = diffusivity_ / (spacing_ * spacing_), growth = growth_;
    Kokkos::parallel_for(
        "reaction diffusion: rate", kiln::RangePolicy(0, last + 1), KOKKOS_LAMBDA(kiln::LocalIndex i) {
          const double before = u(i > 0 ? i - 1 : left), after = u(i < last ? i + 1 : right);
          f(i) = exchange * (before - 2.0 * u(i) + after) + growth * u(i) * (1.0 - u(i));
        });
  }

 private:
  int cells_;
  double spacing_, diffusivity_, growth_, front_;
  Teuchos::RCP<const kiln::Map> rows_, sources_;
  kiln::LocalIndex left_, right_;  ///< where the neighbours of the block's first and last cell stand
  kiln::PositionView positions_;
};

KILN_REGISTER(kiln::Model, ReactionDiffusion, "reaction diffusion", "Fisher's equation on a rod");

}  // namespace
