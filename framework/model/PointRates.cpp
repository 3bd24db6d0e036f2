#include "framework/model/PointRates.hpp"

#include <Tpetra_Map.hpp>
#include <string>

#include "framework/base/Loop.hpp"

namespace kiln {
namespace {

// Labels made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string take_label = "kiln::model::take point";
const std::string put_label = "kiln::model::put point";

class OneAfterTheOther final : public PointRates {
 public:
  OneAfterTheOther(Model& model, const ParameterPoints& points)
      : model_(model),
        points_(points),
        u_("kiln::model::state of a point", local_size(*model.sources()) * model.fields().size()),
        f_("kiln::model::rate of a point", local_size(*model.rows()) * model.fields().size()) {
    if (points_.count() > 0) points_.set(0, model_.parameters());
  }

  void take(const ParameterPoints& points) override { points_ = points; }

  void rates(ConstMatrixView u, double time, const PointMask& wanted, MatrixView f) override {
    for (std::size_t point = 0; point < points_.count(); ++point) {
      if (wanted[point] == 0) continue;
      points_.set(point, model_.parameters());
      take_point(u, point, u_);
      model_.rate(u_, time, f_);
      put_point(f_, point, f);
    }
  }

 private:
  Model& model_;
  ParameterPoints points_;
  VectorView u_, f_;
};

}  // namespace

std::unique_ptr<PointRates> one_after_the_other(Model& model, const ParameterPoints& points) {
  return std::make_unique<OneAfterTheOther>(model, points);
}

void take_point(ConstMatrixView values, std::size_t point, VectorView one) {
  loop(
      take_label, static_cast<LocalIndex>(one.extent(0)),
      KOKKOS_LAMBDA(const LocalIndex i) { one(i) = values(point, i); });
}

void put_point(ConstVectorView one, std::size_t point, MatrixView values) {
  loop(
      put_label, static_cast<LocalIndex>(one.extent(0)),
      KOKKOS_LAMBDA(const LocalIndex i) { values(point, i) = one(i); });
}

}  // namespace kiln
