#include "workbench/live/live_state.h"

#include <algorithm>
#include <cmath>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace workbench::live {
namespace {

double seconds(std::int64_t utc_us) { return static_cast<double>(utc_us) * 1e-6; }

template <class Points>
void forget_older(Points& points, double span_s) {
  while (!points.empty() && points.front().t_s < points.back().t_s - span_s) points.pop_front();
}

// The value of an estimate worth a bar: b1, or else the first that has a band.
std::size_t watched(const spoolwatch::estimate_t& estimate) {
  const auto b1 = std::find(estimate.name.begin(), estimate.name.end(), "b1");
  if (b1 != estimate.name.end()) return static_cast<std::size_t>(b1 - estimate.name.begin());
  for (std::size_t i = 0; i < estimate.name.size(); ++i) {
    if (std::isfinite(estimate.low[i]) || std::isfinite(estimate.high[i])) return i;
  }
  return 0;
}

}  // namespace

void LiveState::on(const spoolwatch::sample_t& sample) {
  state_ = sample.state;
  command_V_ = sample.u_applied_V;
  utc_us_ = sample.utc_us;
  motion_.push_back({seconds(sample.utc_us), sample.reference_m, sample.y_m});
  forget_older(motion_, kMotionSpan_s);
}

void LiveState::on(const spoolwatch::estimate_t& estimate) {
  utc_us_ = estimate.utc_us;
  if (estimate.name.empty()) return;
  const std::size_t i = watched(estimate);
  auto track = std::find_if(tracks_.begin(), tracks_.end(),
                            [&](const TrackedQuantity& t) { return t.source == estimate.source; });
  if (track == tracks_.end()) {
    tracks_.push_back({.source = estimate.source, .quantity = {}, .reason = {}, .history = {}});
    track = tracks_.end() - 1;
  }
  track->quantity = estimate.name[i];
  track->value = estimate.value[i];
  track->std_error = estimate.std_error[i];
  track->low = estimate.low[i];
  track->high = estimate.high[i];
  track->valid = estimate.valid != 0;
  track->reason = estimate.reason;
  track->history.push_back({seconds(estimate.utc_us), track->value, track->valid});
  forget_older(track->history, kValueSpan_s);
}

void LiveState::on(const spoolwatch::alarm_t& alarm) {
  const std::string name = alarm.source + "." + alarm.name;
  auto row = std::find_if(alarms_.begin(), alarms_.end(),
                          [&](const AlarmRow& a) { return a.name == name; });
  const bool changed =
      row == alarms_.end() || row->severity != alarm.severity || row->direction != alarm.direction;
  const std::int64_t since_us = changed ? alarm.utc_us : row->utc_us;
  if (row != alarms_.end()) alarms_.erase(row);
  AlarmRow now{.name = name,
               .utc_us = since_us,
               .severity = alarm.severity,
               .active = alarm.active != 0,
               .value = alarm.value,
               .low = alarm.low,
               .high = alarm.high,
               .parameter = alarm.parameter,
               .direction = alarm.direction,
               .reason = alarm.reason};
  const auto later = [](const AlarmRow& a, const AlarmRow& b) { return a.utc_us > b.utc_us; };
  alarms_.insert(std::upper_bound(alarms_.begin(), alarms_.end(), now, later), now);
}

void LiveState::on(const spoolwatch::health_t& health) {
  state_ = health.state;
  utc_us_ = std::max(utc_us_, health.utc_us);
  health_ = {.rig_id = health.rig_id,
             .privileges = health.privileges,
             .overruns = health.overruns,
             .skipped_periods = health.skipped_periods,
             .dropped_samples = health.dropped_samples,
             .dropped_records = health.dropped_records,
             .lost_records = health.lost_records,
             .lateness_p50_us = health.lateness_p50_us,
             .lateness_p999_us = health.lateness_p999_us,
             .lateness_max_us = health.lateness_max_us};
}

void LiveState::on_new_run(std::int64_t run_id, bool first) {
  *this = LiveState{};
  heard_ = true;
  run_id_ = run_id;
  if (!first) notice_ = "the daemon was restarted";
}

void LiveState::on_lost(const std::string&, std::int64_t count) { lost_messages_ += count; }

}  // namespace workbench::live
