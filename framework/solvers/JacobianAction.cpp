#include "framework/solvers/JacobianAction.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "framework/base/Loop.hpp"

namespace kiln {
namespace {

// Made once: Kokkos takes a std::string, and one made for each call would allocate in the online loop.
const std::string scale_rows_label = "kiln::solvers::scale_rows";

double largest_entry(const ConstVectorView& values) {
  double largest = 0.0;
  Kokkos::parallel_reduce(
      "kiln::solvers::largest_entry", RangePolicy(0, static_cast<LocalIndex>(values.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i, double& most) {
        const double size = values(i) < 0.0 ? -values(i) : values(i);
        if (size > most) most = size;
      },
      Kokkos::Max<double>(largest));
  return largest;
}

void largest_over_ranks(const Communicator& communicator, std::vector<double>& values) {
  const std::vector<double> local = values;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, static_cast<int>(local.size()), local.data(), values.data());
}

void scale_rows(const ConstVectorView& diagonal, const ConstMatrixView& v, const MatrixView& product) {
  for (std::size_t column = 0; column < v.extent(1); ++column) {
    loop(
        scale_rows_label, static_cast<LocalIndex>(diagonal.extent(0)),
        KOKKOS_LAMBDA(const LocalIndex i) { product(i, column) = diagonal(i) * v(i, column); });
  }
}

void shift(const ConstVectorView& u, double step, const ConstVectorView& direction, const VectorView& shifted) {
  Kokkos::parallel_for(
      "kiln::solvers::shift", RangePolicy(0, static_cast<LocalIndex>(u.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { shifted(i) = u(i) + step * direction(i); });
}

void difference_quotient(const ConstVectorView& rate, double step, const VectorView& shifted_rate) {
  Kokkos::parallel_for(
      "kiln::solvers::difference_quotient", RangePolicy(0, static_cast<LocalIndex>(rate.extent(0))),
      KOKKOS_LAMBDA(const LocalIndex i) { shifted_rate(i) = (shifted_rate(i) - rate(i)) / step; });
}

}  // namespace

JacobianAction::JacobianAction(const Model& model, JacobianForm form) : model_(model), form_(form) {
  const std::size_t components = model.fields().size();
  const std::size_t rows = local_size(*model.rows()) * components;
  const std::size_t sources = local_size(*model.sources()) * components;
  if (form_ == JacobianForm::diagonal) {
    diagonal_ = VectorView("kiln::solvers::rate Jacobian diagonal", rows);
    return;
  }
  u_ = VectorView("kiln::solvers::frozen state", sources);
  if (form_ == JacobianForm::finite_difference) {
    rate_ = VectorView("kiln::solvers::frozen rate", rows);
    shifted_ = VectorView("kiln::solvers::shifted state", sources);
  }
}

void JacobianAction::require_offered(ConstVectorView u) const {
  const std::size_t rows = local_size(*model_.rows()) * model_.fields().size();
  switch (form_) {
    case JacobianForm::diagonal:
      return model_.rate_jacobian_diagonal(u, 0.0, VectorView("kiln::solvers::no diagonal", rows));
    case JacobianForm::sparse:
    case JacobianForm::matrix_free:
      return model_.apply_rate_jacobian(u, 0.0, MatrixView("kiln::solvers::no direction", u.extent(0), 1),
                                        MatrixView("kiln::solvers::no change", rows, 1));
    case JacobianForm::finite_difference:
      return;
  }
}

void JacobianAction::take(ConstVectorView u, double time) {
  time_ = time;
  if (form_ == JacobianForm::diagonal) {
    model_.rate_jacobian_diagonal(u, time, diagonal_);
  } else {
    Kokkos::deep_copy(u_, u);
  }
  if (form_ == JacobianForm::finite_difference) {
    model_.rate(u_, time_, rate_);
    ++rate_evaluations_;
    std::vector<double> largest{largest_entry(u_)};
    largest_over_ranks(*model_.rows()->getComm(), largest);
    // A state of zeros has no scale of its own; its unit stands in.
    largest_u_ = largest[0] > 0.0 ? largest[0] : 1.0;
  }
  taken_ = true;
}

void JacobianAction::apply(ConstMatrixView v, MatrixView product) {
  if (!taken_) throw std::logic_error("JacobianAction::apply: no state was taken");
  switch (form_) {
    case JacobianForm::diagonal:
      return scale_rows(diagonal_, v, product);
    case JacobianForm::sparse:
    case JacobianForm::matrix_free:
      return model_.apply_rate_jacobian(u_, time_, v, product);
    case JacobianForm::finite_difference:
      return difference(v, product);
  }
}

void JacobianAction::difference(ConstMatrixView v, MatrixView product) {
  const std::size_t columns = v.extent(1);
  std::vector<double> largest(columns);
  for (std::size_t column = 0; column < columns; ++column) {
    largest[column] = largest_entry(Kokkos::subview(v, Kokkos::ALL, column));
  }
  largest_over_ranks(*model_.rows()->getComm(), largest);
  for (std::size_t column = 0; column < columns; ++column) {
    const VectorView result = Kokkos::subview(product, Kokkos::ALL, column);
    if (largest[column] == 0.0) {
      Kokkos::deep_copy(result, 0.0);
      continue;
    }
    const double step = std::sqrt(std::numeric_limits<double>::epsilon()) * largest_u_ / largest[column];
    shift(u_, step, Kokkos::subview(v, Kokkos::ALL, column), shifted_);
    model_.rate(shifted_, time_, result);
    ++rate_evaluations_;
    difference_quotient(rate_, step, result);
  }
}

}  // namespace kiln
