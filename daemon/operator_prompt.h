// Questions to the person at the terminal, who may also press Ctrl-C.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "daemon/main_event_loop.h"

namespace monitor {

class OperatorPrompt {
 public:
  /// Blocks the stop signals of this thread, so that they are waited for.
  OperatorPrompt(std::ostream& out, bool ask_nobody);

  /// Asks and waits for y or n; nothing when a signal or the end of the input came first. True
  /// without asking when nobody is to be asked.
  std::optional<bool> ask(const std::string& question);
  /// Waits up to 100 ms; whether a signal has come.
  bool wait_stop();
  /// A signal has come, in any of the calls before.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }
  [[nodiscard]] bool asks() const noexcept { return !ask_nobody_; }

 private:
  std::ostream& out_;
  bool ask_nobody_;
  bool stopped_ = false;
  SignalFd signals_;
};

}  // namespace monitor
