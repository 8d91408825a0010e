#include "daemon/main_event_loop.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace monitor {
namespace {

constexpr int kIdleWait_ms = 100;
/// While an answer is outstanding or requests are queued.
constexpr int kBusyWait_ms = 1;

}  // namespace

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, signal);
  return set;
}

SignalFd::SignalFd() {
  const sigset_t set = stop_signals();
  fd_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

SignalFd::~SignalFd() { close(fd_); }

int SignalFd::next() const noexcept {
  signalfd_siginfo info{};
  return read(fd_, &info, sizeof info) == sizeof info ? static_cast<int>(info.ssi_signo) : 0;
}

bool MainEventLoop::run_once() {
  if (socket_ == nullptr) {
    pollfd file{signals_.fd(), POLLIN, 0};
    poll(&file, 1, kIdleWait_ms);
  } else {
    socket_->wait(busy_ ? kBusyWait_ms : kIdleWait_ms, signals_.fd());
    busy_ = handler_.serve(*socket_);
  }
  reloader_.poll();
  for (int signal = signals_.next(); signal != 0; signal = signals_.next()) {
    if (signal != SIGHUP) return true;
    reload_pending_ = true;
  }
  if (reload_pending_ && reloader_.begin(getuid(), "SIGHUP")) reload_pending_ = false;
  return false;
}

}  // namespace monitor
