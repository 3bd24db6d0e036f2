#include "rom/projection/PointProjection.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <cmath>

#include "framework/base/Error.hpp"
#include "framework/method/Divergence.hpp"

namespace kiln {

PointProjection::PointProjection(Projection& projection, const ParameterPoints& points)
    : projection_(projection),
      model_(projection.model()),
      trial_(projection.trial()),
      settings_(projection.settings()),
      points_(points),
      rates_(model_.at_points(points)),
      states_(points.count(), trial_),
      rows_(static_cast<std::size_t>(projection.row_size())),
      size_(static_cast<std::size_t>(trial_.size())),
      jacobian_(model_, settings_.jacobian),
      test_(points.count(), rows_, size_),
      inverse_transposed_(points.count(), size_, size_),
      norms_(points.count()),
      test_norms_(points.count()),
      goals_(points.count()),
      everyone_(points.count(), 1),
      iterates_(points.count()),
      moves_(points.count()),
      point_state_("kiln::rom::state of a point", states_.size()),
      jacobian_tangent_("kiln::rom::J Phi of a point", rows_, size_),
      small_("kiln::rom::reduced Jacobian of a point", size_, size_),
      inverse_("kiln::rom::transposed inverse reduced Jacobian of a point", size_, size_) {
  const auto array = [&](const char* label, std::size_t columns) {
    return uncounted(owners_.emplace_back(std::string(label), points.count(), columns));
  };
  state_ = array("kiln::rom::states of the sources of points", states_.size());
  residual_ = array("kiln::rom::residuals of points", rows_);
  g_ = array("kiln::rom::reduced residuals of points", size_);
  step_ = array("kiln::rom::updates of points", size_);
}

void PointProjection::take(const ParameterPoints& points) {
  points_ = points;
  rates_->take(points);
  age_ = -1;
}

void PointProjection::evaluate(ConstMatrixView x, double time, MatrixView u, MatrixView f) {
  states_.states(x, everyone_, state_);
  rates_->rates(state_, time, everyone_, f);
  std::copy_n(state_.data(), u.size(), u.data());
}

void PointProjection::linearise_point(std::size_t point, const StepResidual& residual) {
  const double alpha = residual.alpha, gamma = residual.gamma;
  const ConstMatrixView tangent = states_.tangent();
  const ConstMatrixView tangent_rows = dense::row_block(tangent, 0, rows_);
  if (gamma != 0.0) {
    points_.set(point, model_.parameters());
    take_point(state_, point, point_state_);
    jacobian_.take(point_state_, residual.time);
    jacobian_.apply(tangent, jacobian_tangent_);
  }
  for (std::size_t k = 0; k < size_; ++k) {
    for (std::size_t i = 0; i < rows_; ++i) {
      const double rate_part = gamma != 0.0 ? gamma * jacobian_tangent_(i, k) : 0.0;
      jacobian_tangent_(i, k) = alpha * tangent_rows(i, k) - rate_part;
    }
  }
  const ConstMatrixView test =
      projection_.test_basis().form(tangent_rows, jacobian_tangent_, *model_.rows()->getComm());
  dense::product(dense::Transpose::yes, dense::Transpose::no, 1.0, test, jacobian_tangent_, 0.0, small_);
  Projection::require_regular(factors_.factor(small_), residual.time);
  factors_.inverse_transposed(inverse_);
  test_.put(point, test);
  double squares = 0.0;
  for (std::size_t k = 0; k < size_; ++k) {
    for (std::size_t i = 0; i < rows_; ++i) squares += test(i, k) * test(i, k);
  }
  test_norms_[point] = std::sqrt(squares);
  inverse_transposed_.put(point, inverse_);
}

void PointProjection::linearise(const StepResidual& residual, MatrixView x, std::vector<Point>& points) {
  if (residual.gamma != 0.0) states_.states(x, everyone_, state_);
  for (std::size_t point = 0; point < points.size(); ++point) {
    if (points[point].divergence) continue;
    try {
      linearise_point(point, residual);
    } catch (const DivergenceError& error) {
      points[point].divergence = error;
      put_point(VectorView("kiln::rom::zero", x.extent(1)), point, x);
    }
  }
  frozen_alpha_ = residual.alpha;
  frozen_gamma_ = residual.gamma;
  age_ = 0;
}

void PointProjection::reduce_residual(const StepResidual& residual, double gamma, ConstMatrixView history,
                                      ConstMatrixView f) {
  const double alpha = residual.alpha;
  over_points(norms_.size(), iterates_, [&](std::size_t point, auto width) {
    using Width = decltype(width);
    // The rows come first among the sources.
    for (std::size_t i = 0; i < rows_; ++i) {
      Width::store(&residual_(point, i), alpha * Width::at(&state_(point, i)) - gamma * Width::at(&f(point, i)) +
                                             Width::at(&history(point, i)));
    }
  });
  test_.multiply_transposed(residual_, iterates_, g_);
  take_norms(g_, norms_);
}

void PointProjection::take_norms(ConstMatrixView arrays, std::vector<double>& norms) const {
  over_points(norms.size(), iterates_, [&](std::size_t point, auto width) {
    using Width = decltype(width);
    typename Width::Numbers sum{};
    for (std::size_t i = 0; i < arrays.extent(1); ++i)
      sum += Width::at(&arrays(point, i)) * Width::at(&arrays(point, i));
    Width::store(&norms[point], sum);
  });
  for (std::size_t point = 0; point < norms.size(); ++point) {
    if (iterates_[point] != 0) norms[point] = std::sqrt(norms[point]);
  }
}

void PointProjection::set_goals(ConstMatrixView history) {
  take_norms(history, goals_);
  for (std::size_t point = 0; point < goals_.size(); ++point) {
    if (iterates_[point] == 0) continue;
    goals_[point] = Projection::goal(settings_.tolerance, norms_[point], test_norms_[point], goals_[point]);
  }
}

void PointProjection::update(MatrixView x) {
  inverse_transposed_.multiply_transposed(g_, iterates_, step_);
  std::copy(iterates_.begin(), iterates_.end(), moves_.begin());
  double* const own = &x(0, trial_.first());
  over_points(iterates_.size(), iterates_, [&](std::size_t point, auto width) {
    using Width = decltype(width);
    const auto moves = Width::at(&moves_[point]);
    for (std::size_t k = 0; k < size_; ++k) {
      double* const coordinate = own + k * iterates_.size() + point;
      // A point left behind has steps that are no numbers.
      const auto step = moves > 0.0 ? Width::at(&step_(point, k)) : typename Width::Numbers{};
      Width::store(coordinate, Width::at(coordinate) - step);
    }
  });
}

void PointProjection::leave_behind(std::size_t point, const char* what, double time, MatrixView x, ConstMatrixView f,
                                   Point& outcome) {
  const VectorView u("kiln::rom::state of a diverged point", rows_), rate("kiln::rom::its rate", rows_),
      measure("kiln::rom::its residual", rows_);
  take_point(state_, point, u);
  take_point(f, point, rate);
  take_point(residual_, point, measure);
  outcome.divergence = divergence(model_, what, time, u, rate, measure);
  iterates_[point] = 0;
  // Its lane goes on with the reference state, which no model chokes on.
  put_point(VectorView("kiln::rom::zero", x.extent(1)), point, x);
}

void PointProjection::watch(const StepResidual& residual, MatrixView x, ConstMatrixView f, std::vector<Point>& points) {
  for (std::size_t point = 0; point < points.size(); ++point) {
    if (iterates_[point] == 0) continue;
    if (!std::isfinite(norms_[point])) {
      leave_behind(point, Projection::not_finite, residual.time, x, f, points[point]);
    } else if (norms_[point] > Projection::growth_limit * points[point].solve.first_norm) {
      leave_behind(point, Projection::grown, residual.time, x, f, points[point]);
    }
  }
}

void PointProjection::iterate(const StepResidual& residual, ConstMatrixView history, MatrixView x, MatrixView f,
                              std::vector<Point>& points) {
  for (int iteration = 0;; ++iteration) {
    bool any = false;
    for (std::size_t point = 0; point < points.size(); ++point) {
      if (iterates_[point] == 0) continue;
      SolveReport& solve = points[point].solve;
      solve.last_norm = norms_[point];
      solve.converged = !(norms_[point] > goals_[point]);
      if (solve.converged || iteration == settings_.iterations) {
        iterates_[point] = 0;
        continue;
      }
      ++solve.iterations;
      ++solve.residuals;
      any = true;
    }
    if (!any) return;
    update(x);
    states_.states(x, iterates_, state_);
    rates_->rates(state_, residual.time, iterates_, f);
    reduce_residual(residual, residual.gamma, history, f);
    watch(residual, x, f, points);
  }
}

void PointProjection::solve(const StepResidual& residual, ConstMatrixView history_held, MatrixView x_held, MatrixView u,
                            MatrixView f_held, std::vector<Point>& points) {
  const ConstMatrixView history = uncounted(history_held);
  const MatrixView x = uncounted(x_held), f = uncounted(f_held);
  const bool is_explicit = residual.gamma == 0.0;
  const bool serves = age_ >= 0 && frozen_alpha_ == residual.alpha && frozen_gamma_ == residual.gamma;
  if (!serves || (!is_explicit && age_ >= settings_.refresh)) linearise(residual, x, points);
  ++age_;
  for (std::size_t point = 0; point < points.size(); ++point) iterates_[point] = points[point].divergence ? 0 : 1;
  states_.states(x, iterates_, state_);
  if (is_explicit) {
    // The rate's factor is zero; any finite array may stand for it.
    reduce_residual(residual, 0.0, history, history);
  } else {
    rates_->rates(state_, residual.time, iterates_, f);
    reduce_residual(residual, residual.gamma, history, f);
  }
  for (std::size_t point = 0; point < points.size(); ++point) {
    points[point].solve = {};
    points[point].solve.first_norm = norms_[point];
    points[point].solve.residuals = 1;
  }
  watch(residual, x, is_explicit ? history : ConstMatrixView(f), points);
  if (is_explicit) {
    update(x);
    for (Point& point : points) point.solve.iterations = 1;
    return evaluate(x, residual.time, u, f);
  }
  set_goals(history);
  iterate(residual, history, x, f, points);
  std::copy_n(state_.data(), u.size(), u.data());
}

}  // namespace kiln
