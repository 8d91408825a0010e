// Yes/no questions to the operator at the terminal; Ctrl-C ends them.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "daemon/main_event_loop.h"

namespace monitor {

class OperatorPrompt {
 public:
  /// Blocks the stop signals in this thread. `assume_yes`: answers every question without asking.
  OperatorPrompt(std::ostream& out, bool assume_yes);

  /// Asks and waits for y or n. Returns nullopt on a signal or the end of the input.
  std::optional<bool> ask(const std::string& question);
  /// Waits up to 100 ms for a stop signal. Returns whether one has been received so far.
  bool wait_stop();
  /// True when any call has received a stop signal.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }
  [[nodiscard]] bool asks() const noexcept { return !assume_yes_; }

 private:
  std::ostream& out_;
  bool assume_yes_;
  bool stopped_ = false;
  SignalFd signals_;
};

}  // namespace monitor
