#include "framework/observers/ProgressObserver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace kiln {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

bool draws_bars() {
  // Under mpirun a rank's standard error is a pipe, whatever stands at its other end; KILN_PROGRESS tells.
  if (const char* wish = std::getenv("KILN_PROGRESS"); wish != nullptr) return std::string_view(wish) == "bar";
  return isatty(STDERR_FILENO) == 1;
}

ProgressObserver::ProgressObserver(std::string label, int first_step, const Communicator& communicator)
    : ProgressObserver(std::move(label), first_step, communicator.getRank() == 0 ? stderr : nullptr, draws_bars()) {}

ProgressObserver::ProgressObserver(std::string label, int first_step, std::FILE* stream, bool terminal)
    : label_(std::move(label)),
      first_step_(first_step),
      stream_(stream),
      terminal_(terminal),
      start_(Clock::now()),
      drawn_(start_) {}

void ProgressObserver::observe(const Moment& moment) {
  if (stream_ == nullptr || moment.last_step <= 0) return;
  if (terminal_) {
    draw_bar(moment);
  } else {
    print_line(moment);
  }
}

void ProgressObserver::draw_bar(const Moment& moment) {
  const Clock::time_point now = Clock::now();
  const bool last = moment.step == moment.last_step;
  if (!last && open_line_ && now - drawn_ < std::chrono::seconds(1)) return;
  drawn_ = now;
  constexpr int width = 30;
  const int filled = static_cast<int>(static_cast<long long>(width) * moment.step / moment.last_step);
  std::string bar;
  for (int i = 0; i < width; ++i) bar += i < filled ? "█" : "░";
  // The escape sequence clears what a longer line left behind.
  fmt::print(stream_, "\r{} {} {:3}% step {}/{}, {}\x1b[K", label_, bar, 100LL * moment.step / moment.last_step,
             moment.step, moment.last_step, time_left(moment));
  open_line_ = !last;
  if (last) std::fputc('\n', stream_);
  std::fflush(stream_);
}

void ProgressObserver::print_line(const Moment& moment) {
  const int tenths = static_cast<int>(10LL * moment.step / moment.last_step);
  if (tenths <= tenths_) return;
  tenths_ = tenths;
  fmt::print(stream_, "{}: {} %, step {} of {}, {}\n", label_, 10 * tenths, moment.step, moment.last_step,
             time_left(moment));
  std::fflush(stream_);
}

std::string ProgressObserver::time_left(const Moment& moment) const {
  const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
  if (moment.step >= moment.last_step) return duration_text(spent) + " in all";
  const int done = moment.step - first_step_;
  if (done <= 0) return "starting";
  return duration_text(spent / done * (moment.last_step - moment.step)) + " left";
}

void ProgressObserver::finish(RunReport&) {
  if (stream_ != nullptr && open_line_) std::fputc('\n', stream_);
  open_line_ = false;
}

}  // namespace kiln
