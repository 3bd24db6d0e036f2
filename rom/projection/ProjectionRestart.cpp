#include <algorithm>
#include <limits>

#include "framework/files/Hdf5.hpp"
#include "rom/projection/Projection.hpp"

namespace kiln {

void Projection::save(hdf5::Group& group) const {
  group.attribute("age", static_cast<long long>(frozen_.age));
  if (frozen_.age < 0) return;
  group.attribute("alpha", frozen_.alpha);
  group.attribute("gamma", frozen_.gamma);
  group.attribute("time", frozen_.time);
  group.write("frozen coordinates", std::vector<double>(frozen_.x.data(), frozen_.x.data() + frozen_.x.extent(0)));
}

void Projection::restore(const hdf5::Group& group, std::size_t x_size) {
  const int age = static_cast<int>(group.integer("age", -1, std::numeric_limits<int>::max()));
  forget_jacobian();
  if (age < 0) return;
  const hdf5::Array<double> x = group.finite_reals("frozen coordinates", {x_size});
  VectorView frozen("kiln::rom::restored coordinates", x.values.size());
  std::copy(x.values.begin(), x.values.end(), frozen.data());
  linearise(group.finite_real("alpha"), group.finite_real("gamma"), frozen, group.finite_real("time"));
  frozen_.age = age;
}

}  // namespace kiln
