#include <fmt/format.h>

#include <Tpetra_Map.hpp>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/files/Hdf5Node.hpp"
#include "framework/files/RowOrder.hpp"

namespace kiln::hdf5 {

void Group::write_rows(const std::string& name, const Map& map, ConstMatrixView values) {
  const RowOrder order(map);
  create_dataset(*node_, name, H5T_NATIVE_DOUBLE, {order.rows(), values.extent(1)}, nullptr, false);
  const std::vector<double> slab = order.slab(values);
  write_slab(*node_, open_dataset(*node_, name), name, {order.first(), 0}, {order.count(), values.extent(1)},
             H5T_NATIVE_DOUBLE, slab.data());
}

MatrixView Group::read_rows(const std::string& name, const Map& map) const {
  const Dataset dataset = open_dataset(*node_, name, H5T_FLOAT);
  if (dataset.shape.size() != 1 && dataset.shape.size() != 2) {
    node_->fail(name, "has shape " + shape_text(dataset.shape), "rows × columns");
  }
  const std::size_t rows = dataset.shape[0];
  const std::size_t columns = dataset.shape.size() == 2 ? dataset.shape[1] : 1;
  const bool wants_any = map.getGlobalNumElements() > 0;
  if (wants_any && map.getMaxAllGlobalIndex() >= static_cast<GlobalIndex>(rows)) {
    node_->fail(name, fmt::format("has {} rows", rows),
                fmt::format("one for each particle, at least {}", map.getMaxAllGlobalIndex() + 1));
  }
  const Teuchos::RCP<const Map> slabs = slab_map(rows, map);
  const std::size_t count = local_size(*slabs);
  std::vector<std::size_t> start{count == 0 ? 0 : static_cast<std::size_t>(slabs->getMinGlobalIndex())};
  std::vector<std::size_t> extent{count};
  if (dataset.shape.size() == 2) {
    start.push_back(0);
    extent.push_back(columns);
  }
  return spread_slabs(read_slab(*node_, dataset, name, start, extent), rows, columns, map);
}

}  // namespace kiln::hdf5
