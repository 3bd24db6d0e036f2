#include "rom/projection/TestBasis.hpp"

#include "framework/base/Collectives.hpp"
#include "rom/linear_algebra/Dense.hpp"

namespace kiln {

GnatTestBasis::GnatTestBasis(MatrixView gappy_operator)
    : gappy_operator_(gappy_operator),
      gappy_operator_transposed_("kiln::rom::transposed gappy operator", gappy_operator.extent(1),
                                 gappy_operator.extent(0)) {
  for (std::size_t i = 0; i < gappy_operator.extent(0); ++i) {
    for (std::size_t k = 0; k < gappy_operator.extent(1); ++k) gappy_operator_transposed_(k, i) = gappy_operator(i, k);
  }
}

ConstMatrixView GnatTestBasis::form(ConstMatrixView, ConstMatrixView jacobian_tangent,
                                    const Communicator& communicator) {
  const std::size_t size = jacobian_tangent.extent(1);
  if (test_.extent(1) != size) {
    reduced_ = MatrixView("kiln::rom::A J Phi", gappy_operator_.extent(0), size);
    test_ = MatrixView("kiln::rom::test basis", gappy_operator_.extent(1), size);
  }
  using dense::Transpose;
  dense::product(Transpose::no, Transpose::no, 1.0, gappy_operator_, jacobian_tangent, 0.0, reduced_);
  sum_over_ranks(communicator, reduced_.data(), reduced_.size());
  dense::product(Transpose::no, Transpose::no, 1.0, gappy_operator_transposed_, reduced_, 0.0, test_);
  return test_;
}

}  // namespace kiln
