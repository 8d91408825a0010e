#include "tests/soak/stream_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/messages/decode.h"

namespace soak {
namespace {

constexpr std::size_t kShown = 40;
constexpr double kHour_s = 3600.0;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int8_t kDisarmed = 1;
constexpr std::int8_t kRun = 3;
/// Estimates of the last hour within so many standard deviations of the first hour's mean.
constexpr double kBound = 8.0;
/// Means of the two hours: relative.
constexpr double kMeanBound = 1e-3;

// Times of the shipped bands. fast: window 0.3 s and stride 0.01 s. period: windows of 2 s one
// after the other, so what is left of one and a whole one; each counts from its newest sample.
constexpr AlarmTimes kFast{0.3 + 0.01, 0.5};
constexpr AlarmTimes kPeriod{2.0 + 2.0, 0.0};

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void Spread::add(double value) noexcept {
  ++count;
  low = count == 1 ? value : std::min(low, value);
  high = count == 1 ? value : std::max(high, value);
  const double off = value - mean;
  mean += off / static_cast<double>(count);
  squares += off * (value - mean);
}

double Spread::deviation() const noexcept {
  return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0.0;
}

StreamCheck::StreamCheck(const std::vector<Fault>& faults, double duration_s,
                         std::int64_t period_ns)
    : faults_(faults), duration_s_(duration_s), period_ns_(period_ns) {
  alarms_.emplace_back("supply_pressure_fast", faults, kFast);
  alarms_.emplace_back("supply_pressure", faults, kPeriod);
  told_.resize(alarms_.size());
}

void StreamCheck::problem(const std::string& what) {
  ++problem_count_;
  if (problems_.size() < kShown) problems_.push_back(what);
}

void StreamCheck::collect() {
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    for (; told_[i] < alarms_[i].problems().size(); ++told_[i]) {
      problem(alarms_[i].problems()[told_[i]]);
    }
  }
}

bool StreamCheck::in_turn(std::size_t channel, std::int64_t seq) {
  const bool good = seq == seq_[channel];
  seq_[channel] = seq + 1;
  return good;
}

void StreamCheck::take(std::string_view channel, const void* data, int size) {
  const auto read = [&](auto& message, auto act) {
    if (!config::messages::decode(message, data, size)) return problem("a message is damaged");
    (this->*act)(message);
  };
  if (channel.ends_with("_SAMPLE")) return read(sample_, &StreamCheck::sample);
  if (channel.ends_with("_ESTIMATE")) return read(estimate_, &StreamCheck::estimate);
  if (channel.ends_with("_ALARM")) return read(alarm_, &StreamCheck::alarm);
  if (channel.ends_with("_HEALTH")) return read(health_, &StreamCheck::health);
  problem("channel " + std::string(channel));
}

bool StreamCheck::healthy() {
  const auto over_s = [](const Fault& fault) {
    return fault.back_s + fault.back_ramp_s + kPeriod.delay_s;
  };
  while (next_fault_ < faults_.size() && over_s(faults_[next_fault_]) <= t_s_) ++next_fault_;
  const bool before = next_fault_ == faults_.size() || t_s_ < faults_[next_fault_].at_s;
  return before && t_s_ >= kPeriod.delay_s;
}

void StreamCheck::sample(const spoolwatch::sample_t& s) {
  const auto wrong = [&](const char* what) {
    problem("sample " + std::to_string(samples_) + ": " + what);
  };
  if (!in_turn(0, s.seq)) wrong("a sequence number is missing");
  if (s.tick != samples_ || s.gap != 0) wrong("a tick is missing");
  const std::int64_t due_ns = s.tick * period_ns_;
  if (s.t_read_ns != due_ns || s.mono_ns != due_ns || s.utc_us != due_ns / 1000) {
    wrong("its time is not tick x period");
  }
  const bool closing = samples_ * period_ns_ >= std::llround(duration_s_ * 1e9);
  if (s.quality != 0 || s.state != (closing ? kDisarmed : kRun)) wrong("not a good one in RUN");
  ++samples_;
  t_s_ = static_cast<double>(due_ns) * 1e-9;
  for (AlarmWatch& alarm : alarms_) alarm.advance(t_s_);
  if (alarms_[0].problems().size() != told_[0] || alarms_[1].problems().size() != told_[1]) {
    collect();
  }
}

void StreamCheck::estimate(const spoolwatch::estimate_t& e) {
  if (!in_turn(1, e.seq)) problem("estimate: a sequence number is missing");
  if (e.tick != samples_ - 1) problem("estimate: of another tick than the newest sample's");
  const bool first = t_s_ < kHour_s;
  const bool last = t_s_ >= duration_s_ - kHour_s;
  if (!first && !last) return;
  if (!e.valid || !healthy()) return;
  for (int i = 0; i < e.size; ++i) {
    const std::string& name = e.name[static_cast<std::size_t>(i)];
    if (name != "a1" && name != "b1") continue;
    auto found = std::find_if(coefficients_.begin(), coefficients_.end(), [&](const auto& c) {
      return c.source == e.source && c.name == name;
    });
    if (found == coefficients_.end()) {
      coefficients_.push_back({e.source, name, {}, {}});
      found = coefficients_.end() - 1;
    }
    const double value = e.value[static_cast<std::size_t>(i)];
    if (first) found->first.add(value);
    if (last) found->last.add(value);
  }
}

void StreamCheck::alarm(const spoolwatch::alarm_t& a) {
  if (!in_turn(2, a.seq)) problem("alarm: a sequence number is missing");
  if (a.repeat) {
    ++repeats_;
    return;
  }
  const auto found = std::find_if(alarms_.begin(), alarms_.end(),
                                  [&](const AlarmWatch& w) { return w.name() == a.name; });
  const double t_s = static_cast<double>(a.tick * period_ns_) * 1e-9;
  if (found == alarms_.end()) {
    return problem(number("%.3f s: ", t_s) + a.source + "." + a.name + ": " + a.reason);
  }
  if (a.tick != samples_ - 1) problem(a.name + " is of another tick than the newest sample's");
  found->see(t_s, a.active, a.direction);
  if (a.severity == 3) problem(number("%.3f s: ", t_s) + a.name + " is INVALID: " + a.reason);
  collect();
}

void StreamCheck::health(const spoolwatch::health_t& h) {
  const auto wrong = [&](const char* what) {
    problem("health " + std::to_string(h.seq) + ": " + what);
  };
  if (!in_turn(3, h.seq)) wrong("a sequence number is missing");
  const bool closing = samples_ * period_ns_ >= std::llround(duration_s_ * 1e9);
  if (!closing && h.mono_ns != (h.seq + 1) * kSecond_ns) wrong("not once a second");
  if (h.ticks != samples_) wrong("another number of ticks than samples were sent");
  if (h.overruns != 0 || h.skipped_periods != 0 || h.dropped_samples != 0) wrong("lost cycles");
  if (h.dropped_records != 0 || h.lost_records != 0) wrong("lost records");
  const auto active =
      std::count_if(alarms_.begin(), alarms_.end(), [](const AlarmWatch& w) { return w.active(); });
  if (h.active_alarms != active) wrong("another number of active alarms than was told");
  if (repeats_ != active) wrong("not each active alarm was sent again");
  repeats_ = 0;
}

void StreamCheck::finish() {
  // The last one is after the end: DISARMED, with the valve at null.
  const auto expected = std::llround(duration_s_ * 1e9) / period_ns_ + 1;
  if (samples_ != expected) {
    problem(std::to_string(samples_) + " samples came of " + std::to_string(expected));
  }
  for (AlarmWatch& alarm : alarms_) alarm.advance(duration_s_);
  collect();
  for (const Coefficient& c : coefficients_) {
    const std::string name = c.source + "." + c.name;
    if (c.first.count == 0 || c.last.count == 0) {
      problem(name + ": no healthy stretch in the first or the last hour");
      continue;
    }
    const double bound = kBound * c.first.deviation();
    if (c.last.low < c.first.mean - bound || c.last.high > c.first.mean + bound) {
      problem(name + ": in the last hour outside of the first hour's bounds");
    }
    if (std::abs(c.last.mean - c.first.mean) > kMeanBound * std::abs(c.first.mean)) {
      problem(name + ": its mean has drifted");
    }
  }
  if (coefficients_.empty()) problem("no valid estimate");
}

}  // namespace soak
