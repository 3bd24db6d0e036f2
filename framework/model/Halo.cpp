#include "framework/model/Halo.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <utility>

#include "framework/model/DegreesOfFreedom.hpp"

namespace kiln {
namespace {

/// A multivector of one column that stands on the memory of `values`.
Teuchos::RCP<MultiVector> column_over(const Teuchos::RCP<const Map>& map, const VectorView& values) {
  return Teuchos::rcp(new MultiVector(map, MatrixView(values.data(), values.extent(0), 1)));
}

}  // namespace

Halo::Halo(const Model& model) {
  const int components = static_cast<int>(model.fields().size());
  rows_ = degree_of_freedom_map(model.rows(), components);
  sources_ = degree_of_freedom_map(model.sources(), components);
  // One rank alone, or ranks that need nothing of each other, exchange nothing.
  if (!rows_->isSameAs(*sources_)) import_ = Teuchos::rcp(new Import(rows_, sources_));
}

void Halo::bring(const MultiVector& rows, MultiVector& sources) const {
  if (import_.is_null()) {
    Tpetra::deep_copy(sources, rows);
  } else {
    sources.doImport(rows, *import_, Tpetra::INSERT);
  }
}

Halo::State::State(const Halo& halo)
    : import_(halo.import_),
      sources_("kiln::model::source state", halo.source_size()),
      rows_(Kokkos::subview(sources_, std::make_pair(LocalIndex(0), halo.row_size()))) {
  if (import_.is_null()) return;
  source_column_ = column_over(halo.sources(), sources_);
  row_column_ = column_over(halo.rows(), rows_);
}

void Halo::State::fill() {
  if (!import_.is_null()) source_column_->doImport(*row_column_, *import_, Tpetra::INSERT);
}

}  // namespace kiln
