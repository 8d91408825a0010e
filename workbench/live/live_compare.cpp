#include "workbench/live/live_compare.h"

#include <unistd.h>

#include <cmath>
#include <iostream>

#include "config/schema/error.h"
#include "config/signals/quality.h"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/listen_feed.h"
#include "workbench/live/online_residual.h"
#include "workbench/present/printed_axis.h"

namespace workbench::live {
namespace {

void say(const std::string& line) { std::cerr << "spoolwatch compare: " << line << std::endl; }

/// On a terminal each line takes the place of the one before.
class Watcher final : public FeedListener {
 public:
  Watcher(const plant_sim::ModelFile& model, const LiveCompareOptions& options)
      : residual_(model, options.observer_per_s),
        json_(options.json),
        terminal_(!options.json && isatty(STDOUT_FILENO) == 1) {}

  void on(const spoolwatch::sample_t& s) override {
    if (config::signals::is_stale(s.quality) || !std::isfinite(s.y_m) ||
        !std::isfinite(s.u_applied_V)) {
      return;
    }
    residual_.add(s.tick, s.sample_time_s, s.u_applied_V, s.y_m);
    const auto second =
        static_cast<std::int64_t>(std::floor(static_cast<double>(s.tick) * s.sample_time_s + 1e-9));
    if (told_ && second == second_) return;
    // The first second has hardly begun.
    if (told_) tell();
    told_ = true;
    second_ = second;
  }
  void on_new_run(std::int64_t run_id, bool first) override {
    say((first ? "daemon found, run " : "the daemon has been restarted, run ") +
        std::to_string(run_id));
  }
  void on_lost(const std::string& channel, std::int64_t count) override {
    if (channel.ends_with("_SAMPLE")) {
      say(std::to_string(count) + " samples lost: the model is initialised again");
    }
  }
  void on_silence(bool silent) override {
    say(silent ? "no daemon is heard" : "a daemon is heard again");
  }
  void on_notice(const std::string& what) override { say(what); }

  void end() {
    if (terminal_ && lines_ > 0) std::cout << '\n';
  }
  [[nodiscard]] bool empty() const noexcept { return lines_ == 0; }

 private:
  void tell() {
    const ResidualFigures figures = residual_.figures();
    if (json_) {
      std::cout << json_of(figures) << std::endl;
    } else if (terminal_) {
      std::cout << '\r' << line_of(figures) << "\033[K" << std::flush;
    } else {
      std::cout << line_of(figures) << std::endl;
    }
    ++lines_;
  }

  OnlineResidual residual_;
  bool json_, terminal_;
  bool told_ = false;
  std::int64_t second_ = 0;
  std::int64_t lines_ = 0;
};

}  // namespace

void watch(const plant_sim::ModelFile& model, const LiveCompareOptions& options) {
  using config::schema::RunError;
  const present::PrintedAxis axis(present::motion_of(model));
  Watcher watcher(model, options);
  {
    ListenFeed feed(options.url, options.prefix, true, watcher);
    while (!options.ended() && std::cout) {
      if (feed.poll(std::chrono::milliseconds(100)) || options.interrupted()) continue;
      if (options.url.starts_with("file:")) break;
      throw RunError("LCM cannot receive on \"" + options.url + "\" any more");
    }
  }
  watcher.end();
  if (watcher.empty() && !options.interrupted()) {
    throw RunError("no samples came on \"" + options.url + "\"");
  }
}

}  // namespace workbench::live
