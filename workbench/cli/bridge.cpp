// spoolwatch bridge: what the daemon says over LCM, live, as JSON in UDP datagrams, which
// PlotJuggler's "UDP Server" takes (message protocol JSON, "timestamp" as the time stamp field).
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "config/messages/channels.h"
#include "config/schema/error.h"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/cli/command.h"
#include "workbench/cli/interrupt.h"
#include "workbench/exchange/message.h"
#include "workbench/exchange/udp_sender.h"
#include "workbench/live/listen_feed.h"

namespace workbench::cli {
namespace {

struct BridgeOptions {
  std::string url = config::messages::kDefaultUrl;
  std::string prefix = config::messages::kDefaultPrefix;
  std::string udp = "127.0.0.1:9870";  // PlotJuggler's own default
  double sample_rate_Hz = 0.0;
  double duration_s = 0.0;
};

void say(const std::string& line) { std::cerr << "spoolwatch bridge: " << line << std::endl; }

class Bridge final : public live::FeedListener {
 public:
  explicit Bridge(const BridgeOptions& options)
      : sender_(exchange::udp_address(options.udp)),
        place_(options.udp),
        sample_rate_Hz_(options.sample_rate_Hz) {}

  void on(const spoolwatch::rods_t& rods) override { rods_ = exchange::to_message(rods); }
  void on(const spoolwatch::pressures_t& pressures) override {
    pressures_ = exchange::to_message(pressures);
  }
  void on(const spoolwatch::sample_t& sample) override {
    const auto rods = std::exchange(rods_, std::nullopt);
    const auto pressures = std::exchange(pressures_, std::nullopt);
    if (sample_rate_Hz_ > 0.0) {
      // The first sample of each period of the rate asked for; a hair early for rounding.
      const double t_s = static_cast<double>(sample.tick) * sample.sample_time_s;
      const double period = std::floor(t_s * sample_rate_Hz_ + 1e-6);
      if (period == last_period_) {
        ++left_out_;
        return;
      }
      last_period_ = period;
    }
    if (rods) send(*rods);
    if (pressures) send(*pressures);
    send(exchange::to_message(sample));
  }
  void on(const spoolwatch::estimate_t& estimate) override { send(exchange::to_message(estimate)); }
  void on(const spoolwatch::alarm_t& alarm) override { send(exchange::to_message(alarm)); }
  void on(const spoolwatch::health_t& health) override { send(exchange::to_message(health)); }
  void on_new_run(std::int64_t run_id, bool first) override {
    last_period_ = -1.0;
    say((first ? "daemon found, run " : "the daemon has been restarted, run ") +
        std::to_string(run_id));
  }
  void on_lost(const std::string&, std::int64_t count) override { lost_ += count; }
  void on_silence(bool silent) override {
    say(silent ? "no daemon is heard" : "a daemon is heard again");
  }
  void on_notice(const std::string& what) override { say(what); }

  void sum_up() const {
    say(std::to_string(sender_.sent()) + " datagrams sent, " + std::to_string(sender_.dropped()) +
        " not sent, " + std::to_string(left_out_) + " samples left out by --sample-rate, " +
        std::to_string(lost_) + " messages lost on LCM");
  }

 private:
  void send(const exchange::Message& message) {
    for (const std::string& datagram : exchange::datagrams_of(message)) {
      const int error = sender_.send(datagram);
      if (error != 0 && !told_) {
        told_ = true;
        say("nothing takes datagrams at " + place_ + " (" + std::strerror(error) + "); sending on");
      }
    }
  }

  exchange::UdpSender sender_;
  std::optional<exchange::Message> rods_, pressures_;  ///< messages of the next sample
  std::string place_;
  double sample_rate_Hz_;
  double last_period_ = -1.0;
  std::uint64_t left_out_ = 0;
  std::int64_t lost_ = 0;
  bool told_ = false;
};

int bridge(const BridgeOptions& options) {
  const StopCondition stop(options.duration_s);
  Bridge bridge(options);
  {
    live::ListenFeed feed(options.url, options.prefix, true, bridge);
    while (!stop.reached()) {
      if (feed.poll(std::chrono::milliseconds(100)) || StopCondition::asked()) continue;
      if (options.url.starts_with("file:")) break;
      throw config::schema::RunError("LCM cannot receive on \"" + options.url + "\" any more");
    }
  }
  bridge.sum_up();
  return 0;
}

}  // namespace

void add_bridge(CLI::App& command, int& exit_code) {
  auto options = std::make_shared<BridgeOptions>();
  command.add_option("--lcm-url", options->url, "LCM URL; file:///LOG?mode=r replays a log")
      ->capture_default_str();
  command.add_option("--prefix", options->prefix, "prefix of the channel names")
      ->capture_default_str();
  command.add_option("--udp", options->udp, "HOST:PORT or [IPV6]:PORT to send to")
      ->capture_default_str();
  command
      .add_option("--sample-rate", options->sample_rate_Hz,
                  "maximum sample rate, Hz (0: all samples)")
      ->check(CLI::Range(0.0, 1e6));
  command.add_option("--duration", options->duration_s, "run time, s (0: unlimited)")
      ->check(CLI::NonNegativeNumber);
  command.callback([options, &exit_code] { exit_code = bridge(*options); });
}

}  // namespace workbench::cli
