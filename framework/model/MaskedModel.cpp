#include "framework/model/MaskedModel.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>

#include "framework/base/Error.hpp"
#include "framework/files/Hdf5.hpp"
#include "framework/model/DegreesOfFreedom.hpp"
#include "framework/model/ParticleMap.hpp"
#include "framework/model/SampleRows.hpp"

namespace kiln {
namespace {

using Indices = Kokkos::View<LocalIndex*, Device>;

void to_full(const Indices& full_source, const ConstMatrixView& masked, const MatrixView& full) {
  for (std::size_t column = 0; column < masked.extent(1); ++column) {
    Kokkos::parallel_for(
        "kiln::model::masked_to_full", RangePolicy(0, static_cast<LocalIndex>(masked.extent(0))),
        KOKKOS_LAMBDA(const LocalIndex i) { full(full_source(i), column) = masked(i, column); });
  }
}

/// Rows are the leading sources, so that the same indices find them.
void from_full(const Indices& full_source, const ConstMatrixView& full, const MatrixView& masked) {
  for (std::size_t column = 0; column < masked.extent(1); ++column) {
    Kokkos::parallel_for(
        "kiln::model::full_to_masked", RangePolicy(0, static_cast<LocalIndex>(masked.extent(0))),
        KOKKOS_LAMBDA(const LocalIndex i) { masked(i, column) = full(full_source(i), column); });
  }
}

ConstVectorView column(const MatrixView& matrix) { return Kokkos::subview(matrix, Kokkos::ALL, 0); }
VectorView writable_column(const MatrixView& matrix) { return Kokkos::subview(matrix, Kokkos::ALL, 0); }
ConstMatrixView as_matrix(const ConstVectorView& vector) { return ConstMatrixView(vector.data(), vector.extent(0), 1); }
MatrixView as_matrix(const VectorView& vector) { return MatrixView(vector.data(), vector.extent(0), 1); }

}  // namespace

MaskedModel::MaskedModel(std::shared_ptr<const Model> full, const std::vector<GlobalIndex>& rows)
    : full_(std::move(full)), chosen_(checked_rows(rows, *full_->rows())), components_(full_->fields().size()) {
  parameters_ = full_->parameters();
  const Map& full_rows = *full_->rows();
  const Map& full_sources = *full_->sources();
  const LocalIndex source_count = local_size(full_sources);
  std::vector<LocalIndex> order;
  std::vector<bool> taken(source_count, false);
  for (const GlobalIndex row : chosen_) {
    if (!full_rows.isNodeGlobalElement(row)) continue;
    order.push_back(full_rows.getLocalElement(row));
    taken[order.back()] = true;
  }
  const std::size_t row_count = order.size();
  for (LocalIndex i = 0; i < source_count; ++i) {
    if (!taken[i]) order.push_back(i);
  }
  std::vector<GlobalIndex> ids;
  for (const LocalIndex i : order) ids.push_back(full_sources.getGlobalElement(i));
  sources_ = map_of(ids, full_sources.getComm());
  ids.resize(row_count);
  rows_ = map_of(ids, full_rows.getComm());

  full_source_ = Indices("kiln::model::full source", order.size() * components_);
  const auto host = Kokkos::create_mirror_view(full_source_);
  for (std::size_t i = 0; i < host.extent(0); ++i) {
    host(i) = static_cast<LocalIndex>(order[i / components_] * components_ + i % components_);
  }
  Kokkos::deep_copy(full_source_, host);
  full_state_ = MatrixView("kiln::model::full state", source_count * components_, 1);
  full_rate_ = MatrixView("kiln::model::full rate", local_size(full_rows) * components_, 1);
}

void MaskedModel::initial_state(VectorView u) const {
  full_->initial_state(writable_column(full_state_));
  from_full(full_source_, full_state_, as_matrix(u));
}

void MaskedModel::rate(ConstVectorView u, double time, VectorView f) const {
  to_full(full_source_, as_matrix(u), full_state_);
  full_->rate(column(full_state_), time, writable_column(full_rate_));
  from_full(full_source_, full_rate_, as_matrix(f));
}

ConstPositionView MaskedModel::positions() const {
  const ConstPositionView full = full_->positions();
  const PositionView positions("kiln::model::positions", local_size(*sources_));
  const auto from = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), full);
  const auto index = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), full_source_);
  const auto to = Kokkos::create_mirror_view(positions);
  for (std::size_t i = 0; i < to.extent(0); ++i) {
    for (int axis = 0; axis < 3; ++axis) to(i, axis) = from(index(i * components_) / components_, axis);
  }
  Kokkos::deep_copy(positions, to);
  return positions;
}

void MaskedModel::rate_jacobian_diagonal(ConstVectorView u, double time, VectorView diagonal) const {
  to_full(full_source_, as_matrix(u), full_state_);
  full_->rate_jacobian_diagonal(column(full_state_), time, writable_column(full_rate_));
  from_full(full_source_, full_rate_, as_matrix(diagonal));
}

void MaskedModel::apply_rate_jacobian(ConstVectorView u, double time, ConstMatrixView v, MatrixView product) const {
  if (full_vectors_.extent(1) != v.extent(1)) {
    full_vectors_ = MatrixView("kiln::model::full vectors", full_state_.extent(0), v.extent(1));
    full_products_ = MatrixView("kiln::model::full products", full_rate_.extent(0), v.extent(1));
  }
  to_full(full_source_, as_matrix(u), full_state_);
  to_full(full_source_, v, full_vectors_);
  full_->apply_rate_jacobian(column(full_state_), time, full_vectors_, full_products_);
  from_full(full_source_, full_products_, product);
}

Teuchos::RCP<const CrsMatrix> MaskedModel::rate_jacobian_matrix(ConstVectorView u, double time) const {
  to_full(full_source_, as_matrix(u), full_state_);
  const Teuchos::RCP<const CrsMatrix> full = full_->rate_jacobian_matrix(column(full_state_), time);
  const auto full_matrix = full->getLocalMatrixHost();
  const auto index = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), full_source_);
  const auto rows = degree_of_freedom_map(rows_, static_cast<int>(components_));
  const auto sources = degree_of_freedom_map(sources_, static_cast<int>(components_));
  const LocalIndex row_count = local_size(*rows);
  const Map& full_columns = *full->getColMap();
  Teuchos::Array<std::size_t> lengths(row_count);
  for (LocalIndex row = 0; row < row_count; ++row) {
    const auto full_row = index(row);
    lengths[row] = full_matrix.graph.row_map(full_row + 1) - full_matrix.graph.row_map(full_row);
  }
  const auto matrix = Teuchos::rcp(new CrsMatrix(rows, sources, lengths()));
  for (LocalIndex row = 0; row < row_count; ++row) {
    const auto full_row = index(row);
    std::vector<LocalIndex> columns;
    std::vector<double> values;
    for (auto k = full_matrix.graph.row_map(full_row); k < full_matrix.graph.row_map(full_row + 1); ++k) {
      columns.push_back(sources->getLocalElement(full_columns.getGlobalElement(full_matrix.graph.entries(k))));
      values.push_back(full_matrix.values(k));
    }
    matrix->insertLocalValues(row, static_cast<LocalIndex>(columns.size()), values.data(), columns.data());
  }
  matrix->fillComplete(full->getDomainMap(), rows);
  return matrix;
}

std::unique_ptr<Model> MaskedModel::sampled(const std::vector<GlobalIndex>& rows) const {
  return std::make_unique<MaskedModel>(full_, checked_rows(rows, *rows_));
}

void MaskedModel::save_sample(hdf5::Group& group) const {
  group.write("rows", std::vector<long long>(chosen_.begin(), chosen_.end()));
}

std::unique_ptr<Model> sampled_or_masked(const std::shared_ptr<const Model>& full,
                                         const std::vector<GlobalIndex>& rows) {
  try {
    return full->sampled(rows);
  } catch (const NotOffered&) {
    return std::make_unique<MaskedModel>(full, rows);
  }
}

}  // namespace kiln
