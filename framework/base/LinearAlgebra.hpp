#pragma once

#include <Kokkos_Core.hpp>
#include <Teuchos_Comm.hpp>
#include <Teuchos_RCP.hpp>
#include <Tpetra_CrsMatrix_decl.hpp>
#include <Tpetra_Import_decl.hpp>
#include <Tpetra_Map_decl.hpp>
#include <Tpetra_MultiVector_decl.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector_decl.hpp>

/// The one place that names template arguments of Tpetra and Kokkos. Everything stays on the default node, so that a
/// Trilinos built for another execution space needs no change elsewhere; Debian's is built for the serial one, and no
/// other has been tried.
namespace kiln {

using Communicator = Teuchos::Comm<int>;

using Map = Tpetra::Map<>;
using LocalIndex = Map::local_ordinal_type;
using GlobalIndex = Map::global_ordinal_type;
using Vector = Tpetra::Vector<double>;
using MultiVector = Tpetra::MultiVector<double>;
using CrsMatrix = Tpetra::CrsMatrix<double>;
using Operator = Tpetra::Operator<double>;
using Import = Tpetra::Import<>;

using Device = Map::device_type;
using ExecutionSpace = Device::execution_space;
using RangePolicy = Kokkos::RangePolicy<ExecutionSpace, LocalIndex>;

/// Local, contiguous arrays on the default device; matrices are column-major, as BLAS and Tpetra hold them.
using VectorView = Kokkos::View<double*, Kokkos::LayoutLeft, Device>;
using ConstVectorView = Kokkos::View<const double*, Kokkos::LayoutLeft, Device>;
using MatrixView = Kokkos::View<double**, Kokkos::LayoutLeft, Device>;
using ConstMatrixView = Kokkos::View<const double**, Kokkos::LayoutLeft, Device>;
/// One row a particle: x, y, z in metres.
using PositionView = Kokkos::View<double* [3], Kokkos::LayoutRight, Device>;
using ConstPositionView = Kokkos::View<const double* [3], Kokkos::LayoutRight, Device>;

/// A view that does not count as an owner of its array, for the lambdas of short loops: counting costs two atomic
/// operations and two look-ups of a thread's own data, as much as a dozen of pairs. The array must outlive it.
template <class View>
using Borrowed = Kokkos::View<typename View::data_type, typename View::array_layout, typename View::device_type,
                              Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
template <class View>
KOKKOS_FORCEINLINE_FUNCTION Borrowed<View> borrowed(const View& view) {
  return view;
}
/// The same for interfaces that take a view of the counting kind: copies of what this returns do not count either.
inline VectorView uncounted(const VectorView& view) { return VectorView(view.data(), view.extent(0)); }
/// Likewise, of a matrix without gaps between its columns.
inline MatrixView uncounted(const MatrixView& view) { return MatrixView(view.data(), view.extent(0), view.extent(1)); }
inline ConstMatrixView uncounted(const ConstMatrixView& view) {
  return ConstMatrixView(view.data(), view.extent(0), view.extent(1));
}

/// Entries of a map on this rank. The member function that says so was renamed between Trilinos 13 and 14.
inline LocalIndex local_size(const Map& map) { return map.getMaxLocalIndex() + 1; }

}  // namespace kiln
