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

}  // namespace workbench::cli
