#include "daemon/null_guard.h"

#include <atomic>
#include <csignal>

namespace monitor {
namespace {

constexpr int kFatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

std::atomic<hal::ValveDrive*> guarded{nullptr};
static_assert(std::atomic<hal::ValveDrive*>::is_always_lock_free);

/// Null, then the signal's own effect.
void on_fatal_signal(int signal) {
  if (hal::ValveDrive* valve = guarded.exchange(nullptr)) valve->go_null();
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

NullGuard::NullGuard(hal::ValveDrive* valve) noexcept {
  guarded.store(valve);
  for (const int signal : kFatal) std::signal(signal, on_fatal_signal);
}

NullGuard::~NullGuard() {
  if (hal::ValveDrive* valve = guarded.exchange(nullptr)) valve->go_null();
  for (const int signal : kFatal) std::signal(signal, SIG_DFL);
}

}  // namespace monitor
