// spoolwatch listen: what the daemon says over LCM, as lines, as JSON or as a live view.
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>

#include "config/messages/channels.h"
#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/cli/interrupt.h"
#include "workbench/live/listen_feed.h"
#include "workbench/live/listen_lines.h"
#include "workbench/live/live_view.h"

namespace workbench::cli {
namespace {

struct ListenOptions {
  std::string url = config::messages::kDefaultUrl;
  std::string prefix = config::messages::kDefaultPrefix;
  bool json = false;
  bool live = false;
  bool alarms_only = false;
  double duration_s = 0.0;
};

int listen_with_lines(const ListenOptions& options) {
  live::LinePrinter printer(std::cout, options.json, options.alarms_only);
  const StopCondition stop(options.duration_s);
  live::ListenFeed feed(options.url, options.prefix, false, printer);
  while (!stop.reached()) {
    if (feed.poll(std::chrono::milliseconds(100)) || StopCondition::asked()) continue;
    if (options.url.starts_with("file:")) return 0;
    throw config::schema::RunError("LCM cannot receive on \"" + options.url + "\" any more");
  }
  return 0;
}

int listen_live(const ListenOptions& options) {
  live::LiveState state;
  const StopCondition stop(options.duration_s);
  live::ListenFeed feed(options.url, options.prefix, true, state);
  live::LiveView view;
  bool more = true;
  while (!stop.reached() && !view.quit_asked()) {
    // After the end of a log its last picture stays.
    if (more) {
      more = feed.poll(std::chrono::milliseconds(100)) || !options.url.starts_with("file:");
    } else {
      ::usleep(100'000);
    }
    view.show(state);
  }
  return 0;
}

int listen(const ListenOptions& options) {
  const bool terminal = ::isatty(STDOUT_FILENO) == 1 && ::isatty(STDIN_FILENO) == 1;
  return options.live && !options.json && terminal ? listen_live(options)
                                                   : listen_with_lines(options);
}

}  // namespace

void add_listen(CLI::App& command, int& exit_code) {
  auto options = std::make_shared<ListenOptions>();
  command.add_option("--lcm-url", options->url, "LCM URL; file:///LOG?mode=r replays a log")
      ->capture_default_str();
  command.add_option("--prefix", options->prefix, "prefix of the channel names")
      ->capture_default_str();
  command.add_option("--duration", options->duration_s, "run time, s (0: unlimited)")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--json", options->json, "one JSON object per line");
  command.add_flag("--alarms", options->alarms_only, "alarms only, without estimates");
  command.add_flag("--live", options->live,
                   "a terminal view; lines when there is no terminal. q quits");
  command.callback([options, &exit_code] { exit_code = listen(*options); });
}

}  // namespace workbench::cli
