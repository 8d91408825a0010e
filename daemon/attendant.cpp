#include "daemon/attendant.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace monitor {
namespace {

constexpr int kLook_ms = 100;
/// While there is something to do: the loop owes an answer, or requests wait.
constexpr int kShortLook_ms = 1;

}  // namespace

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, signal);
  return set;
}

StopFile::StopFile() {
  const sigset_t set = stop_signals();
  file_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

StopFile::~StopFile() { close(file_); }

int StopFile::take() const noexcept {
  signalfd_siginfo info{};
  return read(file_, &info, sizeof info) == sizeof info ? static_cast<int>(info.ssi_signo) : 0;
}

bool Attendant::attend() {
  if (socket_ == nullptr) {
    pollfd file{stop_.file(), POLLIN, 0};
    poll(&file, 1, kLook_ms);
  } else {
    socket_->wait(soon_ ? kShortLook_ms : kLook_ms, stop_.file());
    soon_ = desk_.serve(*socket_);
  }
  reloader_.look();
  for (int signal = stop_.take(); signal != 0; signal = stop_.take()) {
    if (signal != SIGHUP) return true;
    hung_up_ = true;
  }
  if (hung_up_ && reloader_.begin(getuid(), "SIGHUP")) hung_up_ = false;
  return false;
}

}  // namespace monitor
