#include "workbench/live/listen_printer.h"

#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "workbench/live/listen_lines.h"

namespace workbench::live {
namespace {

std::int64_t now_us() {
  using std::chrono::duration_cast;
  return duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

void LinePrinter::on(const spoolwatch::estimate_t& estimate) {
  if (!alarms_only_) line(json_ ? json(estimate) : readable(estimate));
}

void LinePrinter::on(const spoolwatch::alarm_t& alarm) {
  if (json_) {
    line(json(alarm));
    return;
  }
  const std::string key = alarm.source + "." + alarm.name;
  const auto known = active_.find(key);
  const bool news = known == active_.end() || known->second != alarm.severity;
  if (alarm.repeat == 0 || news) line(readable(alarm));
  if (alarm.active) {
    active_[key] = alarm.severity;
  } else {
    active_.erase(key);
  }
}

void LinePrinter::on(const spoolwatch::health_t& health) {
  if (json_) line(json(health));
}

void LinePrinter::on_new_run(std::int64_t run_id, bool first) {
  active_.clear();
  event("run",
        (first ? "listening to run " : "the daemon was restarted: run ") + std::to_string(run_id));
}

void LinePrinter::on_lost(const std::string& channel, std::int64_t count) {
  event("lost", std::to_string(count) + " messages of " + channel + " did not arrive");
}

void LinePrinter::on_silence(bool silent) {
  spoolwatch::alarm_t alarm{};
  alarm.utc_us = now_us();
  alarm.source = "listen";
  alarm.name = "silence";
  alarm.severity = silent ? 2 : 0;
  alarm.active = silent ? 1 : 0;
  alarm.value = alarm.std_error = alarm.low = alarm.high = alarm.confidence =
      std::numeric_limits<double>::quiet_NaN();
  alarm.reason = silent ? "no health message for 3 s" : "health messages arrive";
  alarm.guidance = "see whether spoolwatchd runs and whether URL and prefix are its own";
  on(alarm);
}

void LinePrinter::on_notice(const std::string& what) { event("notice", what); }

void LinePrinter::event(const char* kind, const std::string& what) {
  if (json_) {
    line(nlohmann::ordered_json{{"type", kind}, {"utc_us", now_us()}, {"what", what}}.dump());
  } else {
    line(time_text(now_us()) + "  " + kind + ": " + what);
  }
}

void LinePrinter::line(const std::string& text) { out_ << text << std::endl; }

}  // namespace workbench::live
