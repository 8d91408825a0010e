#include "workbench/cli/interrupt.h"

#include <atomic>
#include <cstdint>
#include <ctime>

namespace workbench::cli {
namespace {

/// Signals that come together are one order: `timeout` sends its own twice, to the program and to
/// its process group.
constexpr std::int64_t kTogether_ns = 300'000'000;

std::atomic<int> came{0};
std::atomic<std::int64_t> first_ns{0};
static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

void take(int signal) {
  if (came == 0) {
    first_ns = now_ns();
    came = signal;
  } else if (now_ns() - first_ns > kTogether_ns) {
    std::signal(signal, SIG_DFL);  // whoever cannot wait presses twice
    std::raise(signal);
  }
}

}  // namespace

Interrupt::Interrupt() {
  came = 0;
  struct sigaction action {};
  action.sa_handler = take;
  action.sa_flags = SA_RESTART;
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
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
