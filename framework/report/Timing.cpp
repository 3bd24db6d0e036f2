#include "framework/report/Timing.hpp"

#include <malloc.h>
#include <sys/resource.h>

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <ctime>
#include <fstream>
#include <sstream>

namespace kiln {
namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Stopwatch::Stopwatch()
    : wall_start_(seconds_of(CLOCK_MONOTONIC)), process_start_(seconds_of(CLOCK_PROCESS_CPUTIME_ID)) {}

double Stopwatch::wall_seconds() const { return seconds_of(CLOCK_MONOTONIC) - wall_start_; }

double Stopwatch::process_seconds() const { return seconds_of(CLOCK_PROCESS_CPUTIME_ID) - process_start_; }

double Stopwatch::cpu_seconds(const Communicator& communicator) const {
  const double mine = process_seconds();
  double sum = 0.0;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_SUM, 1, &mine, &sum);
  return sum;
}

long long peak_memory(const Communicator& communicator) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const long long mine = 1024LL * usage.ru_maxrss;
  long long largest = 0;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &mine, &largest);
  return largest;
}

void reset_peak_memory() {
  malloc_trim(0);
  // proc(5): 5 resets the peak resident set, which getrusage reports.
  std::ofstream("/proc/self/clear_refs") << "5";
}

std::string table_of(Teuchos::StackedTimer& timer, const Teuchos::RCP<const Communicator>& communicator) {
  Teuchos::StackedTimer::OutputOptions options;
  options.output_fraction = true;
  options.output_minmax = communicator->getSize() > 1;
  options.print_warnings = false;
  std::ostringstream text;
  timer.report(text, communicator, options);
  return communicator->getRank() == 0 ? text.str() : std::string();
}

Timers::Timers(const std::string& name) : timer_(Teuchos::rcp(new Teuchos::StackedTimer(name.c_str()))) {
  Teuchos::TimeMonitor::setStackedTimer(timer_);
}

Timers::~Timers() { Teuchos::TimeMonitor::setStackedTimer(Teuchos::null); }

std::string Timers::table(const Teuchos::RCP<const Communicator>& communicator) const {
  timer_->stopBaseTimer();
  return table_of(*timer_, communicator);
}

}  // namespace kiln
