#include "workbench/cli/interrupt.h"

#include <atomic>

namespace workbench::cli {
namespace {

std::atomic<int> came{0};
static_assert(std::atomic<int>::is_always_lock_free);

void take(int signal) { came = signal; }

}  // namespace

Interrupt::Interrupt() {
  came = 0;
  struct sigaction action {};
  action.sa_handler = take;
  // As by default again after the first: whoever cannot wait presses twice.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, &before_int_);
  sigaction(SIGTERM, &action, &before_term_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &before_int_, nullptr);
  sigaction(SIGTERM, &before_term_, nullptr);
}

int Interrupt::exit_code() noexcept {
  constexpr int kSignalled = 128;
  const int signal = came;
  return signal == 0 ? 0 : kSignalled + signal;
}

namespace {

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int) { stop_asked = 1; }

}  // namespace

StopCondition::StopCondition(double duration_s)
    : limited_(duration_s > 0.0),
      at_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::chrono::duration<double>(limited_ ? duration_s : 0.0))) {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool StopCondition::reached() const { return asked() || (limited_ && Clock::now() >= at_); }

bool StopCondition::asked() noexcept { return stop_asked != 0; }

}  // namespace workbench::cli
