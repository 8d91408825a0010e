#include "workbench/live/listen_lines.h"

#include <fmt/chrono.h>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <nlohmann/json.hpp>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"

namespace workbench::live {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kYear2000_us = 946'684'800'000'000;

// A run of severity_text, name and what follows stays aligned for names of ordinary length.
std::string column(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text + "  ";
}

std::string range_text(double low, double high) {
  return number_text(low) + " .. " + number_text(high);
}

ordered_json numbers(const std::vector<double>& values) {
  ordered_json array = ordered_json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

template <class Message>
ordered_json head(const char* type, const Message& message) {
  return {{"type", type},
          {"run_id", message.run_id},
          {"seq", message.seq},
          {"utc_us", message.utc_us},
          {"mono_ns", message.mono_ns}};
}

std::string text(const ordered_json& object) {
  return object.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

std::string time_text(std::int64_t utc_us) {
  if (utc_us < kYear2000_us) return fmt::format("{:.3f} s", static_cast<double>(utc_us) * 1e-6);
  const std::time_t seconds = utc_us / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03}Z", utc, utc_us / 1000 % 1000);
}

constexpr int kInvalid = 3;  // severity of alarm_t

const char* severity_text(int severity) {
  constexpr std::array kText = {"OK", "MINOR", "MAJOR", "INVALID"};
  return severity >= 0 && severity < 4 ? kText[static_cast<std::size_t>(severity)] : "?";
}

const char* state_text(int state) {
  constexpr std::array kText = {"MONITOR", "DISARMED", "ARMED", "RUN", "LATCHED"};
  return state >= 0 && state < 5 ? kText[static_cast<std::size_t>(state)] : "?";
}

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  return fmt::format("{:.{}g}", value, digits);
}

std::string readable(const spoolwatch::alarm_t& alarm) {
  std::string line = column(time_text(alarm.utc_us), 10) +
                     column(severity_text(alarm.severity), 7) +
                     column(alarm.source + "." + alarm.name, 18);
  if (alarm.shelved) {
    line += "shelved; ";
  } else if (!alarm.active) {
    line += "back to normal; ";
  }
  if (alarm.repeat != 0) line += "still active; ";
  if (alarm.latched) line += "latched: normal again, not acknowledged; ";
  if (alarm.active && alarm.acknowledged) line += "acknowledged; ";
  if (alarm.active && alarm.first_up) line += "first of its burst; ";
  if (!alarm.quantity.empty()) {
    line += alarm.quantity + " = " + number_text(alarm.value);
    if (!std::isnan(alarm.std_error)) line += " +- " + number_text(alarm.std_error, 2);
    if (!std::isnan(alarm.low) || !std::isnan(alarm.high)) {
      line += alarm.direction < 0 ? ", below " : alarm.direction > 0 ? ", above " : ", band ";
      line += range_text(alarm.low, alarm.high);
    }
    line += "; ";
  }
  if (alarm.active && !alarm.parameter.empty()) {
    line += "means " + alarm.parameter;
    if (alarm.parameter_direction != 0) line += alarm.parameter_direction < 0 ? " low" : " high";
    for (const auto& other : alarm.ambiguity_group) {
      if (other != alarm.parameter) line += " or " + other;
    }
    line += "; ";
  }
  const bool said = !alarm.quantity.empty() && alarm.severity != kInvalid;
  if (!said && !alarm.reason.empty()) line += alarm.reason + "; ";
  if (alarm.active && !alarm.guidance.empty()) line += "do: " + alarm.guidance + "; ";
  line.erase(line.find_last_not_of("; ") + 1);
  return line;
}

std::string readable(const spoolwatch::estimate_t& estimate) {
  std::string line = column(time_text(estimate.utc_us), 10) + column("-", 7) +
                     column(estimate.source, 18) + "estimate";
  if (!estimate.valid) line += " not valid: " + estimate.reason + ";";
  for (std::size_t i = 0; i < estimate.name.size(); ++i) {
    line += " " + estimate.name[i] + "=" + number_text(estimate.value[i]);
    if (!std::isnan(estimate.std_error[i])) line += "+-" + number_text(estimate.std_error[i], 2);
    const bool outside =
        estimate.value[i] < estimate.low[i] || estimate.value[i] > estimate.high[i];
    if (outside) line += "(out of " + range_text(estimate.low[i], estimate.high[i]) + ")";
  }
  return line;
}

std::string json(const spoolwatch::alarm_t& alarm) {
  ordered_json object = head("alarm", alarm);
  object.update({{"source", alarm.source},
                 {"name", alarm.name},
                 {"severity", severity_text(alarm.severity)},
                 {"active", alarm.active != 0},
                 {"repeat", alarm.repeat != 0},
                 {"latched", alarm.latched != 0},
                 {"acknowledged", alarm.acknowledged != 0},
                 {"shelved", alarm.shelved != 0},
                 {"first_up", alarm.first_up != 0},
                 {"tick", alarm.tick},
                 {"quantity", alarm.quantity},
                 {"value", alarm.value},
                 {"std_error", alarm.std_error},
                 {"low", alarm.low},
                 {"high", alarm.high},
                 {"parameter", alarm.parameter},
                 {"direction", alarm.direction},
                 {"parameter_direction", alarm.parameter_direction},
                 {"confidence", alarm.confidence},
                 {"ambiguity_group", alarm.ambiguity_group},
                 {"reason", alarm.reason},
                 {"guidance", alarm.guidance}});
  return text(object);
}

std::string json(const spoolwatch::estimate_t& estimate) {
  ordered_json object = head("estimate", estimate);
  object.update({{"source", estimate.source},
                 {"tick", estimate.tick},
                 {"valid", estimate.valid != 0},
                 {"reason", estimate.reason},
                 {"condition", estimate.condition},
                 {"name", estimate.name},
                 {"value", numbers(estimate.value)},
                 {"std_error", numbers(estimate.std_error)},
                 {"low", numbers(estimate.low)},
                 {"high", numbers(estimate.high)}});
  return text(object);
}

std::string json(const spoolwatch::health_t& health) {
  ordered_json object = head("health", health);
  object.update({{"rig_id", health.rig_id},
                 {"config_hash", health.config_hash},
                 {"privileges", health.privileges},
                 {"state", state_text(health.state)},
                 {"ticks", health.ticks},
                 {"overruns", health.overruns},
                 {"skipped_periods", health.skipped_periods},
                 {"dropped_samples", health.dropped_samples},
                 {"dropped_records", health.dropped_records},
                 {"lost_records", health.lost_records},
                 {"lateness_p50_us", health.lateness_p50_us},
                 {"lateness_p999_us", health.lateness_p999_us},
                 {"lateness_max_us", health.lateness_max_us},
                 {"read_p999_us", health.read_p999_us},
                 {"control_p999_us", health.control_p999_us},
                 {"write_p999_us", health.write_p999_us},
                 {"active_alarms", health.active_alarms},
                 {"device", health.device},
                 {"device_good", health.device_good},
                 {"device_bad", health.device_bad}});
  return text(object);
}

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
    line(ordered_json{{"type", kind}, {"utc_us", now_us()}, {"what", what}}.dump());
  } else {
    line(time_text(now_us()) + "  " + kind + ": " + what);
  }
}

void LinePrinter::line(const std::string& text) { out_ << text << std::endl; }

}  // namespace workbench::live
