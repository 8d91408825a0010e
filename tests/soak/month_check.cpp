#include "tests/soak/month_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/messages/decode.h"

namespace soak {
namespace {

constexpr std::size_t kShown = 40;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Conditions of the daemon itself are looked at once a second, a failed disk is tried again after
/// one, and a guard's alarm needs a few periods.
constexpr std::int64_t kNoticed_ns = 3 * kSecond_ns;
/// Until a controller that a wrong reading has misled, and windows of 2 s, are over it.
constexpr std::int64_t kSettled_ns = 30 * kSecond_ns;
constexpr std::int8_t kGood = 0, kStale = 2, kBad = 3;

std::int64_t ns(double s) { return std::llround(s * 1e9); }

}  // namespace

MonthCheck::MonthCheck(MonthPlan plan, double duration_s, std::int64_t period_ns)
    : plan_(std::move(plan)), duration_s_(duration_s), period_ns_(period_ns) {}

void MonthCheck::problem(const std::string& what) {
  ++problem_count_;
  if (problems_.size() >= kShown) return;
  char time[32];
  std::snprintf(time, sizeof time, "%.3f s: ", time_s());
  problems_.push_back(time + what);
}

std::int64_t MonthCheck::sent() const noexcept {
  std::int64_t sent = 0;
  for (const auto& [channel, next] : next_seq_) sent += next;
  return sent;
}

void MonthCheck::take(std::string_view channel, const void* data, int size) {
  const auto read = [&](auto message, auto act) {
    if (!config::messages::decode(message, data, size)) return problem("a message is damaged");
    auto next = next_seq_.find(channel);
    if (next == next_seq_.end()) next = next_seq_.emplace(channel, 0).first;
    if (message.seq != next->second) problem(next->first + ": a sequence number is missing");
    next->second = message.seq + 1;
    act(message);
  };
  if (channel.ends_with("_SAMPLE")) {
    return read(spoolwatch::sample_t{}, [this](const auto& s) { sample(s); });
  }
  if (channel.ends_with("_ESTIMATE")) return read(spoolwatch::estimate_t{}, [](const auto&) {});
  if (channel.ends_with("_ALARM")) {
    return read(spoolwatch::alarm_t{}, [this](const auto& a) { alarm(a); });
  }
  if (channel.ends_with("_HEALTH")) {
    return read(spoolwatch::health_t{}, [this](const auto& h) { health(h); });
  }
  problem("channel " + std::string(channel));
}

void MonthCheck::sample(const spoolwatch::sample_t& s) {
  const auto wrong = [&](const char* what) {
    problem("sample " + std::to_string(s.seq) + ": " + what);
  };
  const std::int64_t lost = s.tick - last_tick_ - 1;
  if (lost < 0) wrong("its tick does not rise");
  if (s.gap != lost) wrong("states another gap than its tick");
  // The planned lateness of this wake-up, whole periods of which are lost.
  std::int64_t late_ns = 0;
  while (late_ < plan_.late.size() && plan_.late[late_].at_ns <= s.t_read_ns) {
    late_ns = plan_.late[late_++].late_ns;
  }
  if (late_ns == 0 && lost > 0) wrong("lost periods without a late wake-up");
  if (late_ns >= period_ns_ && std::abs(lost * period_ns_ - late_ns) > period_ns_) {
    wrong("another number of lost periods than the wake-up was late");
  }
  const std::int64_t off_ns = s.t_read_ns - s.tick * period_ns_;
  if (off_ns != (late_ns < period_ns_ ? late_ns : 0)) wrong("is not on the grid");
  samples_ += 1;
  lost_periods_ += std::max<std::int64_t>(lost, 0);
  gaps_ += lost > 0 ? 1 : 0;
  last_tick_ = s.tick;
  now_ns_ = std::max(now_ns_, s.t_read_ns);

  while (step_ < plan_.steps.size() && plan_.steps[step_].at_ns <= s.mono_ns) {
    utc_offset_us_ = plan_.steps[step_++].offset_us;
  }
  static constexpr std::int64_t kEpoch_us = 1'700'000'000'000'000;
  if (s.utc_us != kEpoch_us + s.mono_ns / 1000 + utc_offset_us_) wrong("its wall clock is off");

  expect_alarms();
  const double t_s = static_cast<double>(s.tick * period_ns_) * 1e-9;
  std::int8_t quality = kGood;
  if (device_ < plan_.devices.size() && t_s >= plan_.devices[device_].from_s &&
      t_s < plan_.devices[device_].to_s) {
    const std::string& kind = plan_.devices[device_].kind;
    if (kind == "missing") quality = kBad;
    if (kind == "stale") quality = kStale;
  }
  if (s.quality != quality) wrong("another quality than its sensor's");
}

void MonthCheck::expect_alarms() {
  if (device_ < plan_.devices.size() && now_ns_ > ns(plan_.devices[device_].to_s) + kSettled_ns) {
    const DeviceFault& fault = plan_.devices[device_];
    if (!device_seen_) problem("no alarm " + fault.alarm + " for " + fault.kind);
    device_seen_ = false;
    ++device_;
  }
  if (disk_ < plan_.disk.size() && now_ns_ > plan_.disk[disk_].to_ns + kNoticed_ns) {
    if (!disk_seen_ && plan_.disk[disk_].trouble != DiskTrouble::short_writes) {
      problem("no alarm for the recorder's disk");
    }
    disk_seen_ = false;
    ++disk_;
  }
}

bool MonthCheck::explained(const spoolwatch::alarm_t& a) const {
  if (a.source == "recorder") {
    return disk_ < plan_.disk.size() && now_ns_ >= plan_.disk[disk_].from_ns;
  }
  // Lost periods raise lost_periods and overrun, and leave estimators too few samples.
  for (std::size_t i = late_ > 0 ? late_ - 1 : 0; i < plan_.late.size(); ++i) {
    const LateWakeUp& late = plan_.late[i];
    if (late.late_ns >= period_ns_ && late.at_ns <= now_ns_ &&
        now_ns_ < late.at_ns + late.late_ns + kNoticed_ns) {
      return true;
    }
    if (late.at_ns > now_ns_) break;
  }
  return device_ < plan_.devices.size() && now_ns_ >= ns(plan_.devices[device_].from_s);
}

void MonthCheck::see(const std::string& alarm) {
  if (device_ < plan_.devices.size() && alarm == plan_.devices[device_].alarm &&
      now_ns_ >= ns(plan_.devices[device_].from_s)) {
    device_seen_ = true;
  }
  if (disk_ < plan_.disk.size() && now_ns_ >= plan_.disk[disk_].from_ns) {
    const char* wanted =
        plan_.disk[disk_].trouble == DiskTrouble::full ? "disk_full" : "write_failed";
    disk_seen_ = disk_seen_ || alarm == wanted;
  }
}

void MonthCheck::alarm(const spoolwatch::alarm_t& a) {
  now_ns_ = std::max(now_ns_, a.mono_ns);  // it may be sent before the sample that brought it
  if (a.repeat != 0) ++repeats_;
  if (a.active == 0) return;
  see(a.name);
  if (a.repeat != 0) return;
  ++comings_;
  if (!explained(a)) problem(a.source + "." + a.name + " without a fault: " + a.reason);
}

void MonthCheck::health(const spoolwatch::health_t& h) {
  const auto wrong = [&](const char* what) {
    problem("health " + std::to_string(h.seq) + ": " + what);
  };
  if (h.ticks != samples_) wrong("another number of ticks than samples were sent");
  if (h.skipped_periods != lost_periods_) wrong("another number of skipped periods");
  if (h.overruns != gaps_) wrong("another number of overruns than of gaps");
  if (h.dropped_samples != 0 || h.dropped_records != 0) wrong("a queue was full");
  if (h.lost_records < last_.lost_records) wrong("lost records went back");
  if (h.active_alarms != repeats_) wrong("not each active alarm was sent again");
  repeats_ = 0;
  last_ = h;
}

void MonthCheck::finish(const std::map<std::string, std::int64_t>& report) {
  const auto value = [&](const std::string& name) {
    const auto found = report.find(name);
    return found == report.end() ? 0 : found->second;
  };
  const auto equal = [&](const std::string& what, std::int64_t one, std::int64_t other) {
    if (one == other) return;
    problem(what + ": " + std::to_string(one) + " and " + std::to_string(other));
  };
  equal("samples and lost periods, and periods", samples_ + lost_periods_,
        std::llround(duration_s_ * 1e9) / period_ns_ + 1);
  for (const auto& [channel, sent] : next_seq_) unlogged_ += sent - value(channel);
  equal("messages sent that are not in the log, and lost records of health", unlogged_,
        last_.lost_records);
  equal("messages sent that are not in the log, and of the daemon's last line", unlogged_,
        value("unlogged"));
  equal("messages logged out of turn", value("out_of_turn"), 0);
  equal("logs that end within a message", value("partial"), 0);
  equal("alarms that stand at the end", last_.active_alarms, 0);
  equal("faults of devices that are over", static_cast<std::int64_t>(device_),
        static_cast<std::int64_t>(plan_.devices.size()));
}

}  // namespace soak
