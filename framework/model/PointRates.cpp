#include "framework/model/PointRates.hpp"

#include <Tpetra_Map.hpp>

namespace kiln {
namespace {

class OneAfterTheOther final : public PointRates {
 public:
  OneAfterTheOther(Model& model, const ParameterPoints& points)
      : model_(model),
        points_(points),
        u_("kiln::model::state of a point", local_size(*model.sources()) * model.fields().size()),
        f_("kiln::model::rate of a point", local_size(*model.rows()) * model.fields().size()) {
    if (points_.count() > 0) points_.set(0, model_.parameters());
  }

  void rates(ConstMatrixView u, double time, MatrixView f) override {
    for (std::size_t point = 0; point < points_.count(); ++point) {
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
  Kokkos::parallel_for(
      "kiln::model::take point", RangePolicy(0, static_cast<LocalIndex>(one.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { one(i) = values(point, i); });
}

void put_point(ConstVectorView one, std::size_t point, MatrixView values) {
  Kokkos::parallel_for(
      "kiln::model::put point", RangePolicy(0, static_cast<LocalIndex>(one.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { values(point, i) = one(i); });
}

}  // namespace kiln
