#include "framework/model/Model.hpp"

#include <Teuchos_TypeNameTraits.hpp>

#include "framework/base/Error.hpp"
#include "framework/model/PointRates.hpp"

namespace kiln {

std::string Model::class_name() const { return Teuchos::demangleName(typeid(*this).name()); }

ConstPositionView Model::positions() const { throw NotOffered(class_name(), "positions"); }

void Model::rate_jacobian_diagonal(ConstVectorView, double, VectorView) const {
  throw NotOffered(class_name(), "rate_jacobian_diagonal", "choose time.newton.jacobian: finite difference");
}

void Model::apply_rate_jacobian(ConstVectorView, double, ConstMatrixView, MatrixView) const {
  throw NotOffered(class_name(), "apply_rate_jacobian", "choose time.newton.jacobian: finite difference");
}

Teuchos::RCP<const CrsMatrix> Model::rate_jacobian_matrix(ConstVectorView, double) const {
  throw NotOffered(class_name(), "rate_jacobian_matrix", "choose time.newton.jacobian: finite difference");
}

std::unique_ptr<Model> Model::sampled(const std::vector<GlobalIndex>&) const {
  throw NotOffered(class_name(), "sampled");
}

std::unique_ptr<PointRates> Model::at_points(const ParameterPoints& points) {
  return one_after_the_other(*this, points);
}

void Model::save_sample(hdf5::Group&) const { throw NotOffered(class_name(), "save_sample"); }

}  // namespace kiln
