#include "rom/projection/ReducedBlock.hpp"

#include <fmt/format.h>
#include <Tpetra_Map.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "framework/base/Error.hpp"

namespace kiln {

ReducedBlock::ReducedBlock(PetrovGalerkin& method, const LinearMultistep& scheme, AdvancesTogether::Request request)
    : method_(method),
      count_(request.points),
      everyone_(count_, 1),
      places_(std::move(request.places)),
      history_(scheme, request.step, count_, local_size(*method.coordinates())),
      x_("kiln::rom::coordinates of points", count_, local_size(*method.coordinates())),
      windows_(method.window_count()),
      states_(count_),
      outcomes_(count_) {}

ReducedBlock::Window& ReducedBlock::window(std::size_t number) {
  std::unique_ptr<Window>& window = windows_[number];
  if (window == nullptr) {
    window = std::make_unique<Window>();
    window->projection = std::make_unique<PointProjection>(method_.projection(number), points_);
    window->told_space = method_.held(number).restricted(places_, static_cast<int>(method_.fields().size()));
    window->told = std::make_unique<PointStates>(count_, *window->told_space);
  } else {
    window->projection->take(points_);
  }
  return *window;
}

void ReducedBlock::enter(std::size_t number) {
  window_ = number;
  whole_levels_ = 0;
  Window& entered = window(number);
  entered.told->begin(x_);
  history_.allocate_rows(entered.projection->row_size());
  // Oldest first: the state in which the newest level ends is the one the window begins in.
  history_.visit([&entered](PointHistory::Level& level) {
    entered.projection->begin(level.x);
    entered.projection->evaluate(level.x, level.time, level.u, level.f);
  });
}

void ReducedBlock::start(const ParameterPoints& points) {
  if (points.count() != count_) throw std::invalid_argument("ReducedBlock::start: points of another number");
  points_ = points;
  started_ = true;
  history_.forget();
  states_.assign(count_, {});
  outcomes_.assign(count_, {});
  const VectorView one("kiln::rom::coordinates of a point", x_.extent(1));
  for (std::size_t point = 0; point < count_; ++point) {
    points_.set(point, method_.parameters());
    method_.projection(0).initial(one);
    put_point(one, point, x_);
  }
  enter(0);
  PointHistory::Level& first = history_.next();
  Kokkos::deep_copy(first.x, x_);
  first.time = 0.0;
  PointProjection& projection = *windows_.front()->projection;
  projection.begin(first.x);
  projection.evaluate(first.x, first.time, first.u, first.f);
  history_.accept();
}

void ReducedBlock::keep_coordinates(const MatrixView& kept) {
  // Those of windows past are in each level that was written since.
  const bool all = whole_levels_ < history_.levels();
  whole_levels_ += all ? 1 : 0;
  const TrialSpace& space = method_.projection(window_).trial();
  // Columns, one after the other: Kokkos::deep_copy would wait for all kernels.
  const std::size_t first = all ? 0 : static_cast<std::size_t>(space.first()) * count_;
  const std::size_t count = all ? x_.size() : static_cast<std::size_t>(space.size()) * count_;
  std::copy_n(x_.data() + first, count, kept.data() + first);
}

void ReducedBlock::advance(int step, double time) {
  if (!started_) throw std::logic_error("ReducedBlock::advance: not started");
  const std::size_t number = method_.window_at(time);
  if (number != window_) enter(number);
  const ConstMatrixView history = history_.gather();
  PointHistory::Level& next = history_.next();
  windows_[window_]->projection->solve({history_.scheme().alpha[0], history_.gamma(), time, {}}, history, x_, next.u,
                                       next.f, states_);
  keep_coordinates(next.x);
  next.time = time;
  history_.accept();
  for (std::size_t point = 0; point < states_.size(); ++point) {
    PointOutcome& outcome = outcomes_[point];
    if (!outcome.divergence.empty()) continue;
    if (states_[point].divergence) {
      outcome.divergence = states_[point].divergence->at_step(step).what();
      continue;
    }
    outcome.add(states_[point].solve);
  }
}

std::unique_ptr<PointBlock> PetrovGalerkin::point_block(Request request) {
  const auto refuse = [](const char* path, const std::string& found, const char* expected) {
    throw InputError(path, found + " is not offered to points that advance together",
                     fmt::format("{}, or queries.together: 1, which runs one point after the other", expected));
  };
  const auto* scheme = dynamic_cast<const LinearMultistep*>(&request.scheme);
  if (scheme == nullptr || scheme->starts_by_runge_kutta()) {
    refuse("time.scheme", scheme == nullptr ? "a Runge-Kutta scheme" : "a scheme that starts by Runge-Kutta steps",
           "a linear multistep scheme of order up to 3 (explicit: 2)");
  }
  if (settings_.line_search) refuse("time.newton.line_search", "a line search", "line_search: false");
  for (const OwnedWindow& window : windows_) {
    if (window.projection->when_factored() != Projection::Factors::kept) {
      refuse("method.factors", "factoring in every iteration", "factors: kept");
    }
  }
  if (particles_->getComm()->getSize() != 1) {
    throw std::logic_error("PetrovGalerkin::point_block: the method is spread over several ranks");
  }
  return std::make_unique<ReducedBlock>(*this, *scheme, std::move(request));
}

}  // namespace kiln
