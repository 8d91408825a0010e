#include "daemon/operator_prompt.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <ostream>

namespace monitor {
namespace {

constexpr int kWait_ms = 100;

/// Blocks the signals before the signalfd is created; passes `value` through.
bool block_stop_signals(bool value) {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return value;
}

}  // namespace

OperatorPrompt::OperatorPrompt(std::ostream& out, bool assume_yes)
    : out_(out), assume_yes_(block_stop_signals(assume_yes)) {}

bool OperatorPrompt::wait_stop() {
  pollfd file{signals_.fd(), POLLIN, 0};
  poll(&file, 1, kWait_ms);
  stopped_ = stopped_ || signals_.pending();
  return stopped_;
}

std::optional<bool> OperatorPrompt::ask(const std::string& question) {
  if (assume_yes_)
    return signals_.pending() ? (stopped_ = true, std::nullopt) : std::optional(true);
  out_ << question << " [y/n] " << std::flush;
  std::string answer;
  for (;;) {
    pollfd files[] = {{signals_.fd(), POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    if (poll(files, 2, -1) < 0) continue;
    if (signals_.pending()) {
      stopped_ = true;
      out_ << '\n';
      return std::nullopt;
    }
    if (files[1].revents == 0) continue;
    char letter = 0;
    if (read(STDIN_FILENO, &letter, 1) != 1) {
      out_ << '\n';
      return std::nullopt;
    }
    if (letter != '\n') {
      answer += letter;
      continue;
    }
    if (answer == "y" || answer == "yes") return true;
    if (answer == "n" || answer == "no") return false;
    answer.clear();
    out_ << "y or n? " << std::flush;
  }
}

}  // namespace monitor
