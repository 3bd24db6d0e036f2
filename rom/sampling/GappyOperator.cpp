#include "rom/sampling/GappyOperator.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "framework/base/Error.hpp"

namespace kiln {

GappyOperator gappy_operator(const ConstMatrixView& sampled_modes, const std::string& path) {
  const std::size_t rows = sampled_modes.extent(0), modes = sampled_modes.extent(1);
  if (rows < modes) throw std::logic_error(fmt::format("{} sampled rows cannot determine {} modes", rows, modes));
  const dense::Svd svd = dense::svd(sampled_modes);
  const double largest = svd.values.front(), smallest = svd.values.back();
  if (!(smallest > 1e-13 * largest)) {
    throw InputError(path,
                     fmt::format("the sampled particles cannot tell the residual modes apart: the smallest singular "
                                 "value of PΦ_r is {:.1e}, the largest {:.1e}",
                                 smallest, largest),
                     "more samples or a smaller residual basis");
  }
  // A = V Σ⁻¹ Uᵀ.
  MatrixView scaled("kiln::rom::V over sigma", modes, modes);
  for (std::size_t k = 0; k < modes; ++k) {
    for (std::size_t i = 0; i < modes; ++i) scaled(i, k) = svd.right_transposed(k, i) / svd.values[k];
  }
  GappyOperator result{MatrixView("kiln::rom::gappy operator", modes, rows), smallest, largest / smallest};
  dense::product(dense::Transpose::no, dense::Transpose::yes, 1.0, scaled, svd.left, 0.0, result.matrix);
  return result;
}

}  // namespace kiln
