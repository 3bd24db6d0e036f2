#include <Tpetra_Map.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/files/Hdf5.hpp"
#include "rom/projection/PetrovGalerkin.hpp"

namespace kiln {

void PetrovGalerkin::save(hdf5::Group& group) const {
  group.attribute("age", static_cast<long long>(frozen_.age));
  if (frozen_.age < 0) return;
  group.attribute("alpha", frozen_.alpha);
  group.attribute("gamma", frozen_.gamma);
  group.attribute("time", frozen_.time);
  group.write("frozen coordinates", std::vector<double>(frozen_.x.data(), frozen_.x.data() + frozen_.x.extent(0)));
}

void PetrovGalerkin::restore(const hdf5::Group& group) {
  const int age = static_cast<int>(group.integer("age"));
  frozen_.age = -1;
  if (age < 0) return;
  const hdf5::Array<double> x = group.reals("frozen coordinates", {frozen_.x.extent(0)});
  VectorView frozen("kiln::rom::restored coordinates", x.values.size());
  std::copy(x.values.begin(), x.values.end(), frozen.data());
  linearise(group.real("alpha"), group.real("gamma"), frozen, group.real("time"));
  frozen_.age = age;
}

void PetrovGalerkin::report(nlohmann::json& section) const {
  long long rows = static_cast<long long>(model_->rows()->getGlobalNumElements());
  section["basis_rank"] = trial_->size();
  section["rows"] = rows;
  section["jacobian"] = to_text(settings_.jacobian);
  section["refresh"] = settings_.refresh;
  section["linearisations"] = linearisations_;
  section["reduced_jacobian_reciprocal_condition"] = reciprocal_condition_;
}

}  // namespace kiln
