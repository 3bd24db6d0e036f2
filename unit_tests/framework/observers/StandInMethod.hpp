#pragma once

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "framework/base/Error.hpp"
#include "framework/method/Method.hpp"
#include "framework/model/DegreesOfFreedom.hpp"

namespace kiln {

/// A method whose unknown is the state of particles on a 4 × 3 × 2 lattice, 10 µm apart, dealt to the ranks like cards.
/// Two components.
class StandInMethod : public Method {
 public:
  static constexpr int particle_count = 24;
  static constexpr double spacing = 1e-5;

  StandInMethod() {
    const auto world = Tpetra::getDefaultComm();
    std::vector<GlobalIndex> ids;
    for (GlobalIndex id = particle_count - 1; id >= 0; --id) {
      if (id % world->getSize() == world->getRank()) ids.push_back(id);
    }
    map_ = Teuchos::rcp(new Map(particle_count, ids.data(), static_cast<LocalIndex>(ids.size()), 0, world));
    positions_ = PositionView("kiln::test::positions", ids.size());
    const auto host = Kokkos::create_mirror_view(positions_);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      host(i, 0) = spacing * static_cast<double>(ids[i] % 4);
      host(i, 1) = spacing * static_cast<double>(ids[i] / 4 % 3);
      host(i, 2) = spacing * static_cast<double>(ids[i] / 12);
    }
    Kokkos::deep_copy(positions_, host);
    ids_ = std::move(ids);
  }

  /// 300 K + id + step/3 and −id.
  static double temperature(long long id, int step) { return 300.0 + static_cast<double>(id) + step / 3.0; }
  VectorView unknown(int step) const {
    VectorView x("kiln::test::unknown", 2 * ids_.size());
    const auto host = Kokkos::create_mirror_view(x);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      host(2 * i) = temperature(ids_[i], step);
      host(2 * i + 1) = -static_cast<double>(ids_[i]);
    }
    Kokkos::deep_copy(x, host);
    return x;
  }

  Teuchos::RCP<const Map> particles() const override { return map_; }
  ConstPositionView positions() const override { return positions_; }
  NearestParticle nearest(const std::array<double, 3>& point) const override {
    return nearest_particle(*map_, positions_, point);
  }
  std::vector<std::string> warnings() const override { return {}; }
  std::vector<Field> fields() const override { return {{"temperature", "K"}, {"phase", "1"}}; }
  void state(ConstVectorView x, VectorView u) const override { Kokkos::deep_copy(u, x); }
  Reader reader(const std::vector<LocalIndex>& places) const override {
    return [this, places](ConstVectorView x, VectorView u) {
      const VectorView all("kiln::test::state", 2 * ids_.size());
      state(x, all);
      for (std::size_t i = 0; i < places.size(); ++i) {
        for (int c = 0; c < 2; ++c) u(2 * i + c) = all(2 * places[i] + c);
      }
    };
  }
  void report(nlohmann::json&) const override {}
  void report_work(nlohmann::json&) const override {}

  Teuchos::RCP<const Map> coordinates() const override { return degree_of_freedom_map(map_, 2); }
  bool begin_step(double) override { throw NotOffered("StandInMethod", "begin_step"); }
  LocalIndex row_size() const override { throw NotOffered("StandInMethod", "row_size"); }
  void forget() override { throw NotOffered("StandInMethod", "forget"); }
  void initial(VectorView) const override { throw NotOffered("StandInMethod", "initial"); }
  void evaluate(ConstVectorView, double, VectorView, VectorView) override {
    throw NotOffered("StandInMethod", "evaluate");
  }
  int rate(ConstVectorView, double, VectorView) override { throw NotOffered("StandInMethod", "rate"); }
  void require_jacobian() override { throw NotOffered("StandInMethod", "require_jacobian"); }
  SolveReport solve(const StepResidual&, VectorView, VectorView, VectorView) override {
    throw NotOffered("StandInMethod", "solve");
  }
  Parameters& parameters() override { throw NotOffered("StandInMethod", "parameters"); }
  void save(hdf5::Group&) const override { throw NotOffered("StandInMethod", "save"); }
  void restore(const hdf5::Group&) override { throw NotOffered("StandInMethod", "restore"); }

 private:
  Teuchos::RCP<const Map> map_;
  std::vector<GlobalIndex> ids_;
  PositionView positions_;
};

/// The same particles behind three coordinates: û = (step, 2 step, −step) on every rank.
class ReducedStandIn : public StandInMethod {
 public:
  Teuchos::RCP<const Map> coordinates() const override {
    return Teuchos::rcp(new Map(3, 0, Tpetra::getDefaultComm(), Tpetra::LocallyReplicated));
  }
  void state(ConstVectorView x, VectorView u) const override {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
    Kokkos::deep_copy(u, unknown(static_cast<int>(host(0))));
  }
  static VectorView reduced_unknown(int step) {
    VectorView x("kiln::test::coordinates", 3);
    const auto host = Kokkos::create_mirror_view(x);
    host(0) = step;
    host(1) = 2.0 * step;
    host(2) = -step;
    Kokkos::deep_copy(x, host);
    return x;
  }
};

}  // namespace kiln
