#include "framework/files/RowOrder.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "framework/base/Collectives.hpp"

namespace kiln {
namespace {

[[noreturn]] void throw_shared() { throw std::logic_error("RowOrder: a particle lies on more than one rank"); }

std::vector<long long> own_ids(const Map& map) {
  const auto list = map.getMyGlobalIndices();
  return {list.data(), list.data() + list.extent(0)};
}

/// All ids of a small set on every rank, sorted.
std::vector<long long> gathered_ids(const Map& map) {
  std::vector<long long> ids = concatenated(*map.getComm(), own_ids(map));
  std::sort(ids.begin(), ids.end());
  return ids;
}

bool is_dense(const Map& map) {
  const auto rows = static_cast<GlobalIndex>(map.getGlobalNumElements());
  return rows == 0 || (map.getMinAllGlobalIndex() == 0 && map.getMaxAllGlobalIndex() + 1 == rows);
}

}  // namespace

RowOrder::RowOrder(const Map& map) : slabs_(slab_map(map.getGlobalNumElements(), map)) {
  ids_.resize(local_size(*slabs_));
  first_ = ids_.empty() ? 0 : static_cast<std::size_t>(slabs_->getMinGlobalIndex());
  if (is_dense(map)) {
    if (!map.isOneToOne()) throw_shared();
    particles_ = Teuchos::rcp(new Map(map));
    std::iota(ids_.begin(), ids_.end(), static_cast<long long>(first_));
  } else {
    const std::vector<long long> all = gathered_ids(map);
    if (std::adjacent_find(all.begin(), all.end()) != all.end()) throw_shared();
    std::vector<GlobalIndex> rows;
    for (const long long id : own_ids(map)) {
      rows.push_back(static_cast<GlobalIndex>(std::lower_bound(all.begin(), all.end(), id) - all.begin()));
    }
    particles_ =
        Teuchos::rcp(new Map(map.getGlobalNumElements(), Teuchos::arrayViewFromVector(rows), 0, map.getComm()));
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(first_), ids_.size(), ids_.begin());
  }
  import_ = Teuchos::rcp(new Import(particles_, slabs_));
}

std::size_t RowOrder::rows() const { return slabs_->getGlobalNumElements(); }

std::vector<double> RowOrder::slab(ConstMatrixView values) const {
  const std::size_t columns = values.extent(1);
  std::vector<double> result(count() * columns);
  if (columns == 0) return result;
  MultiVector source(particles_, columns), target(slabs_, columns);
  Kokkos::deep_copy(source.getLocalViewDevice(Tpetra::Access::OverwriteAll), values);
  target.doImport(source, *import_, Tpetra::REPLACE);
  const auto host = target.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t c = 0; c < columns; ++c) result[i * columns + c] = host(i, c);
  }
  return result;
}

Teuchos::RCP<const Map> slab_map(std::size_t rows, const Map& map) {
  return Teuchos::rcp(new Map(rows, 0, map.getComm(), Tpetra::GloballyDistributed));
}

MatrixView spread_slabs(const std::vector<double>& slab, std::size_t rows, std::size_t columns, const Map& map) {
  MatrixView result("kiln::files::rows", local_size(map), columns);
  if (columns == 0) return result;
  const Teuchos::RCP<const Map> slabs = slab_map(rows, map);
  const Teuchos::RCP<const Map> wanted = Teuchos::rcp(new Map(map));
  MultiVector source(slabs, columns), target(wanted, columns);
  {
    const auto host = source.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t i = 0; i < host.extent(0); ++i) {
      for (std::size_t c = 0; c < columns; ++c) host(i, c) = slab[i * columns + c];
    }
  }
  target.doImport(source, Import(slabs, wanted), Tpetra::REPLACE);
  Kokkos::deep_copy(result, target.getLocalViewDevice(Tpetra::Access::ReadOnly));
  return result;
}

}  // namespace kiln
