// spoolwatch record -o F.csv: a record from the running daemon, off its LCM stream.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "config/messages/channels.h"
#include "config/schema/error.h"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/cli/command.h"
#include "workbench/cli/interrupt.h"
#include "workbench/live/listen_feed.h"
#include "workbench/live/sample_file.h"

namespace workbench::cli {
namespace {

using config::schema::RunError;
using live::SampleFile;

struct RecordOptions {
  std::string url = config::messages::kDefaultUrl;
  std::string prefix = config::messages::kDefaultPrefix;
  std::string out;
  double duration_s = 0.0;
};

/// Longer than the record itself, for a daemon that is still to be heard.
constexpr double kPatience_s = 5.0;

void say(const std::string& line) { std::cerr << "spoolwatch record: " << line << std::endl; }

class Recording final : public live::FeedListener {
 public:
  explicit Recording(const RecordOptions& options)
      : file_(options.out), duration_s_(options.duration_s) {
    if (file_.kept().empty()) return;
    say("an earlier record that was cut off is kept as " + file_.kept().string());
  }

  void on(const spoolwatch::rods_t& rods) override { file_.note(rods); }
  void on(const spoolwatch::pressures_t& pressures) override { file_.note(pressures); }
  void on(const spoolwatch::sample_t& sample) override {
    if (complete_ || !ended_.empty()) return;
    if (file_.rows() > 0 && (sample.tick <= tick_ || sample.sample_time_s != sample_time_s_)) {
      ended_ = "the sample counter restarted";
      return;
    }
    if (file_.rows() == 0) first_tick_ = sample.tick;
    sample_time_s_ = sample.sample_time_s;
    const double since_s = static_cast<double>(sample.tick - first_tick_) * sample_time_s_;
    if (duration_s_ > 0.0 && since_s >= duration_s_ - 0.5 * sample_time_s_) {
      complete_ = true;
      return;
    }
    tick_ = sample.tick;
    file_.add(sample);
  }
  void on_new_run(std::int64_t run_id, bool first) override {
    if (first) return say("daemon found, run " + std::to_string(run_id));
    if (file_.rows() > 0) ended_ = "the daemon has been restarted";
  }
  void on_lost(const std::string& channel, std::int64_t count) override {
    if (channel.ends_with("_SAMPLE") && !over()) lost_ += count;
  }
  void on_silence(bool silent) override {
    say(silent ? "no daemon is heard" : "a daemon is heard again");
  }
  void on_notice(const std::string& what) override { say(what); }

  [[nodiscard]] bool over() const noexcept { return complete_ || !ended_.empty(); }
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  [[nodiscard]] SampleFile& file() noexcept { return file_; }

  /// One line, and whether the record is what was asked for.
  void sum_up(const std::string& out) const {
    std::cout << fmt::format(
        "{}: {} samples, {:.6g} s; {} gaps of {} periods together ({} datagrams lost, {} samples "
        "without a good position)\n",
        out, file_.rows(), file_.duration_s(), file_.gaps(), file_.missing(), lost_,
        file_.unusable());
    if (!ended_.empty()) say(ended_ + ": the record ends there");
  }

 private:
  SampleFile file_;
  double duration_s_;
  double sample_time_s_ = 0.0;
  std::int64_t first_tick_ = 0, tick_ = 0;
  std::int64_t lost_ = 0;
  bool complete_ = false;
  std::string ended_;
};

int record(const RecordOptions& options) {
  const bool limited = options.duration_s > 0.0;
  const StopCondition stop(limited ? options.duration_s + kPatience_s : 0.0);
  Recording recording(options);
  {
    live::ListenFeed feed(options.url, options.prefix, true, recording);
    while (!stop.reached() && !recording.over()) {
      if (feed.poll(std::chrono::milliseconds(20)) || StopCondition::asked()) continue;
      if (options.url.starts_with("file:")) break;
      throw RunError("LCM cannot receive on \"" + options.url + "\" any more");
    }
  }
  recording.file().finish();
  if (recording.file().rows() == 0) {
    throw RunError("no sample came on \"" + options.url + "\": nothing is written");
  }
  recording.sum_up(options.out);
  const bool as_asked = recording.complete() || StopCondition::asked() || !limited;
  return as_asked ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

void add_record(CLI::App& command, int& exit_code) {
  auto options = std::make_shared<RecordOptions>();
  command.add_option("-o,--output", options->out, "the record (CSV)")->required();
  command
      .add_option("--duration", options->duration_s, "length of the record, s (0: until Ctrl-C)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--lcm-url", options->url, "LCM URL; file:///LOG?mode=r reads a log")
      ->capture_default_str();
  command.add_option("--prefix", options->prefix, "prefix of the channel names")
      ->capture_default_str();
  command.callback([options, &exit_code] { exit_code = record(*options); });
}

}  // namespace workbench::cli
