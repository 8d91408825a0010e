#include "daemon/safe_state_valve.h"

#include <csignal>

#include "hal/thread.h"

namespace monitor {
namespace {

/// All signals that end a process, except the stop signals (main_event_loop.h), the ignored ones
/// and SIGKILL.
constexpr int kFatal[] = {SIGSEGV, SIGBUS,  SIGFPE,  SIGILL,  SIGABRT, SIGSYS,    SIGTRAP, SIGQUIT,
                          SIGXCPU, SIGUSR1, SIGUSR2, SIGALRM, SIGPROF, SIGVTALRM, SIGIO};

std::atomic<SafeStateValve*> valve_of_process{nullptr};
static_assert(std::atomic<SafeStateValve*>::is_always_lock_free);
static_assert(std::atomic<bool>::is_always_lock_free);

/// Commands null, then raises the signal with its default action.
void on_fatal_signal(int signal) {
  if (SafeStateValve* valve = valve_of_process.exchange(nullptr)) valve->close();
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

SafeStateValve::SafeStateValve(hal::ValveDrive* valve) noexcept : valve_(valve) {
  static hal::SignalStack main_stack;
  main_stack.use();
  valve_of_process.store(this);
  struct sigaction action {};
  action.sa_handler = on_fatal_signal;
  action.sa_flags = SA_ONSTACK;  // a stack that has overflowed can run no handler
  for (const int signal : kFatal) sigaction(signal, &action, nullptr);
}

SafeStateValve::~SafeStateValve() {
  if (valve_of_process.exchange(nullptr) != nullptr) close();
  for (const int signal : kFatal) std::signal(signal, SIG_DFL);
}

void SafeStateValve::close() noexcept {
  closed_.store(true);
  if (valve_ != nullptr) valve_->end_at_null();
}

hal::Applied SafeStateValve::write(double u_V, const hal::Tick& tick) noexcept {
  const hal::Applied applied = valve_->write(u_V, tick);
  return closed_.load() ? valve_->go_null() : applied;
}

hal::Applied SafeStateValve::go_null() noexcept { return valve_->go_null(); }

hal::Applied SafeStateValve::end_at_null() noexcept {
  closed_.store(true);
  return valve_->end_at_null();
}

void ignore_write_signals() noexcept {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

}  // namespace monitor
