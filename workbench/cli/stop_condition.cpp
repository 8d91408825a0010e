#include "workbench/cli/stop_condition.h"

#include <csignal>

namespace workbench::cli {
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
