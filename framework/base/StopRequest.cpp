#include "framework/base/StopRequest.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <csignal>

namespace kiln {
namespace {

volatile std::sig_atomic_t signal_that_came = 0;

extern "C" void note_signal(int number) { signal_that_came = number; }

void watch(int signal, const struct sigaction& action, struct sigaction& before) {
  sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
}

}  // namespace

SignalWatch::SignalWatch() {
  signal_that_came = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;
  sigemptyset(&action.sa_mask);
  // Once: the second signal does what it does to any program. Interrupted system calls go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  watch(SIGTERM, action, terminate_before_);
  watch(SIGINT, action, interrupt_before_);
}

SignalWatch::~SignalWatch() {
  sigaction(SIGTERM, &terminate_before_, nullptr);
  sigaction(SIGINT, &interrupt_before_, nullptr);
  signal_that_came = 0;
}

bool StopRequest::came(int step) {
  if (communicator_.getSize() == 1) return signal_that_came != 0;
  if (!interval_.due(step)) return false;
  // The least of all ranks: 0 for a signal, else the steps until they agree again.
  const int mine = signal_that_came != 0 ? 0 : interval_.steps_to_come(step);
  int least = mine;
  Teuchos::reduceAll(communicator_, Teuchos::REDUCE_MIN, 1, &mine, &least);
  interval_.exchanged(step, least);
  return least == 0;
}

void StopRequest::end_if_asked(const Communicator& communicator, const std::string& what) {
  const int mine = signal_that_came;
  int any = 0;
  Teuchos::reduceAll(communicator, Teuchos::REDUCE_MAX, 1, &mine, &any);
  if (any != 0) throw Stopped((any == SIGTERM ? "SIGTERM" : "SIGINT") + (" came: stopped " + what));
}

std::string StopRequest::name() {
  if (signal_that_came == SIGTERM) return "SIGTERM";
  return signal_that_came == SIGINT ? "SIGINT" : "a signal";
}

}  // namespace kiln
