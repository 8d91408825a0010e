#include "daemon/detection/detector.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "estimator/fdi/snapshot.h"

namespace monitor::detection {

using config::signals::Sample;
using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::Severity;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Ids of all rod sensors, the configured one first.
std::vector<std::string> rods_of(const Detector::Identity& identity) {
  std::vector<std::string> rods{control::kRodId};
  rods.insert(rods.end(), identity.spare_rods.begin(), identity.spare_rods.end());
  return rods;
}

double us(std::int64_t time_ns) { return static_cast<double>(time_ns) * 1e-3; }

}  // namespace

Detector::Detector(const Parts& parts, const Identity& identity)
    : parts_(parts),
      changed_([this](const Alarm& alarm) { publish(alarm, false); }),
      guard_alarms_(identity.guards, parts.pipeline.alarms()),
      rod_alarms_(rods_of(identity), identity.sample_time_s),
      alarm_commands_(parts.alarms.commands, parts.alarms.answers),
      spare_rods_(std::min(identity.spare_rods.size(), rt::kMaxSpareRods)),
      inputs_(std::min(identity.inputs.size(), rt::kMaxInputs)),
      next_second_ns_(parts.clock.now_ns() + kSecond_ns) {
  parts_.publisher.name_rods(rods_of(identity));
  health_.rig_id = identity.rig_id;
  health_.config_hash = identity.config_hash;
  health_.privileges = identity.privileges;
  health_.device = {"rod." + identity.rod};
  if (!identity.valve.empty()) health_.device.push_back("valve." + identity.valve);
  for (std::size_t i = 0; i < spare_rods_; ++i) {
    health_.device.push_back("spare_rod." + identity.spare_rods[i]);
  }
  for (std::size_t i = 0; i < inputs_; ++i) health_.device.push_back("input." + identity.inputs[i]);
  for (const control::GuardConfig& guard : identity.guards) guard_ids_.push_back(guard.id);
  health_.device_count = static_cast<std::int32_t>(health_.device.size());
  health_.device_good.resize(health_.device.size());
  health_.device_bad.resize(health_.device.size());
}

void Detector::drain() {
  Sample sample;
  while (parts_.samples.pop(sample)) process(sample);
}

void Detector::poll() {
  apply_updates();
  alarm_commands_.serve(parts_.pipeline.alarms(), changed_);
  drain();
  if (parts_.alarms.store != nullptr)
    parts_.alarms.store->keep(parts_.pipeline.alarms(), parts_.clock.utc_us());
  if (parts_.clock.now_ns() < next_second_ns_) return;
  once_a_second();
  next_second_ns_ += kSecond_ns;
  if (next_second_ns_ <= parts_.clock.now_ns())
    next_second_ns_ = parts_.clock.now_ns() + kSecond_ns;
}

void Detector::finish() {
  drain();
  once_a_second();
  if (parts_.alarms.store != nullptr)
    parts_.alarms.store->keep(parts_.pipeline.alarms(), parts_.clock.utc_us());
}

void Detector::process(const Sample& sample) {
  tick_ = sample.tick;
  if (parts_.alarms.evidence != nullptr && parts_.alarms.evidence->wants_state(tick_)) {
    estimator::fdi::save_snapshot(parts_.pipeline, parts_.alarms.pipeline_hash, tick_, snapshot_);
    parts_.alarms.evidence->state(snapshot_, tick_);
  }
  guard_alarms_.report(parts_.stats.guards, tick_, changed_);
  rod_alarms_.report(sample, parts_.pipeline.alarms(), changed_);
  parts_.publisher.sample(sample);
  if (sample.state != state_) {
    state_ = sample.state;
    update_latched_alarm();
  }
  parts_.pipeline.process(sample, *this);
  parts_.stats.detected_samples.add();
}

void Detector::on_estimate(const estimator::fdi::EstimateEvent& event) {
  parts_.publisher.estimate(event, stamp());
  if (parts_.detectability != nullptr) parts_.detectability->update(event);
}

void Detector::on_alarm(const Alarm& alarm) { publish(alarm, false); }

void Detector::publish(const Alarm& alarm, bool repeat) {
  parts_.publisher.alarm(alarm, repeat, stamp());
  if (repeat) return;
  if (parts_.alarms.store != nullptr) parts_.alarms.store->note(alarm, parts_.clock.utc_us());
  if (parts_.alarms.evidence != nullptr) keep_evidence(alarm);
}

void Detector::keep_evidence(const Alarm& alarm) {
  const auto& all = parts_.pipeline.alarms().alarms();
  times_.resize(all.size(), 0);
  std::int64_t& times = times_[static_cast<std::size_t>(&alarm - all.data())];
  const bool came = alarm.times != times && alarm.annunciated() && alarm.source != "evidence";
  times = alarm.times;
  if (came) parts_.alarms.evidence->alarm(alarm, stamp().utc_us);
}

void Detector::apply_updates() {
  std::shared_ptr<DetectionUpdate> change;
  while (parts_.updates.pending != nullptr && parts_.updates.pending->pop(change)) {
    apply_update(*change);
    parts_.updates.applied->push(change);
  }
}

void Detector::apply_update(DetectionUpdate& change) {
  estimator::fdi::Pipeline& next = *change.pipeline;
  AlarmBook& before = parts_.pipeline.alarms();
  if (!change.guards.empty()) guard_alarms_.set_limits(change.guards);
  guard_alarms_.declare_in(next.alarms());
  next.alarms().adopt_conditions(before);
  const std::vector<bool> goes_on = next.inherit(parts_.pipeline);
  for (std::size_t i = 0; i < goes_on.size(); ++i) {
    (goes_on[i] ? change.warm : change.cold).push_back(change.estimators[i]);
  }
  for (const Alarm& alarm : before.alarms()) {
    const std::string id = alarm.source + "." + alarm.name;
    if (!alarm.stands() || next.alarms().find(id) != AlarmBook::kNone) continue;
    Alarm ended = alarm;
    ended.severity = Severity::ok;
    ended.active = ended.latched = ended.first_up = ended.shelved = ended.chattering = false;
    ended.acknowledged = true;
    ended.direction = 0;
    ended.tick = tick_;
    ended.reason = "removed from the configuration";
    parts_.publisher.alarm(ended, false, stamp());
    change.ended.push_back(id);
  }
  std::swap(parts_.pipeline, next);
  if (parts_.detectability != nullptr) parts_.detectability->clear();
  parts_.alarms.pipeline_hash = change.pipeline_hash;
  health_.config_hash = change.config_hash;
  // Alarms that stood before the update already have their evidence.
  times_.clear();
  for (const Alarm& alarm : parts_.pipeline.alarms().alarms()) times_.push_back(alarm.times);
  if (parts_.alarms.evidence != nullptr)
    parts_.alarms.evidence->reconfigure(std::move(change.evidence_files));
  change.tick = tick_;
}

void Detector::condition(const char* source, const char* name, Severity severity, bool active,
                         std::string_view reason) {
  const Alarm* alarm = parts_.pipeline.alarms().set_condition(source, name, severity, active,
                                                              active ? reason : "", tick_);
  if (alarm != nullptr) publish(*alarm, false);
}

void Detector::update_latched_alarm() {
  const bool latched = state_ == static_cast<std::uint8_t>(control::ArmingState::latched);
  condition("loop", "latched", Severity::major, latched, latched ? why_latched() : "");
}

std::string Detector::why_latched() const {
  const auto index = parts_.stats.trip_guard.load(std::memory_order_relaxed);
  const std::string id = index < guard_ids_.size() ? guard_ids_[index] : "?";
  switch (parts_.stats.trip.load(std::memory_order_relaxed)) {
    case rt::Trip::overrun:
      return "too many lost periods: reset, then arm again";
    case rt::Trip::reading:
      return "position missing: reset, then arm again";
    case rt::Trip::write:
      return "valve not written: reset, then arm again";
    case rt::Trip::e_stop:
      return "emergency stop: release it, reset, then arm again";
    case rt::Trip::e_stop_unread:
      return "the emergency stop cannot be read: check its device and bus; reset, then arm again";
    case rt::Trip::guard:
      return "guard " + id + ": reset, then arm again";
    case rt::Trip::none:
      break;
  }
  return "";
}

void Detector::once_a_second() {
  const std::int64_t overruns = parts_.stats.overruns.value();
  const std::int64_t dropped = parts_.stats.dropped_samples.value();
  condition("loop", "lost_periods", Severity::minor, overruns > overruns_before_,
            "periods were lost in the last second");
  condition("loop", "dropping", Severity::invalid, dropped > dropped_before_,
            "the detector cannot keep up: samples were dropped in the last second");
  overruns_before_ = overruns;
  dropped_before_ = dropped;
  system_alarms_.report(
      parts_.publisher.status(),
      parts_.recorder != nullptr ? parts_.recorder->status() : io::RecorderStatus{}, tick_,
      parts_.pipeline.alarms(), changed_,
      parts_.alarms.evidence != nullptr ? parts_.alarms.evidence->status() : io::EvidenceStatus{});
  update_alarm_file_alarms();
  parts_.pipeline.alarms().for_each_active([this](const Alarm& alarm) { publish(alarm, true); });
  health();
}

void Detector::update_alarm_file_alarms() {
  if (parts_.alarms.store != nullptr) {
    const int error = parts_.alarms.store->error();
    condition("alarms", "not_saved", Severity::minor, error != 0,
              error != 0 ? std::string("alarm states cannot be saved for a restart: ") +
                               std::strerror(error)
                         : "");
    parts_.alarms.store->retry_history();
    const bool waits = parts_.alarms.store->waiting_history() > 0;
    condition("alarms", "history_not_saved", Severity::minor, waits,
              "changes of alarms wait until history.log can be written; the statistics lack them");
    const std::int64_t given_up = parts_.alarms.store->lost_history();
    history_losing_ = given_up > history_lost_before_ || (history_losing_ && waits);
    condition(io::kHistoryLost[0], io::kHistoryLost[1], Severity::minor, history_losing_,
              "changes of alarms could not be written to history.log");
    history_lost_before_ = given_up;
  }
  if (parts_.alarms.audit == nullptr) return;
  const std::int64_t lost = parts_.alarms.audit->lost();
  condition("alarms", "audit_lost", Severity::minor, lost > audit_lost_before_,
            "operator commands could not be written to the audit file");
  audit_lost_before_ = lost;
}

void Detector::health() {
  const rt::LoopStats& stats = parts_.stats;
  health_.state = static_cast<std::int8_t>(stats.state.load(std::memory_order_relaxed));
  health_.ticks = stats.ticks.value();
  health_.overruns = stats.overruns.value();
  health_.skipped_periods = stats.skipped_periods.value();
  health_.dropped_samples = stats.dropped_samples.value();
  const io::RecorderStatus recorder =
      parts_.recorder != nullptr ? parts_.recorder->status() : io::RecorderStatus{};
  health_.dropped_records = recorder.dropped_records;
  health_.lost_records = recorder.lost_records;
  health_.lateness_p50_us = us(stats.lateness.quantile_ns(0.5));
  health_.lateness_p999_us = us(stats.lateness.quantile_ns(0.999));
  health_.lateness_max_us = us(stats.lateness.max_ns());
  health_.read_p999_us = us(stats.read.quantile_ns(0.999));
  health_.control_p999_us = us(stats.control.quantile_ns(0.999));
  health_.write_p999_us = us(stats.write.quantile_ns(0.999));
  health_.active_alarms = static_cast<std::int32_t>(parts_.pipeline.alarms().active_count());
  parts_.stats.active_alarms.store(health_.active_alarms, std::memory_order_relaxed);
  health_.device_good[0] = stats.rod.good.value();
  health_.device_bad[0] = stats.rod.bad.value();
  std::size_t at = 1;
  const auto next = [&](const rt::Counter& good, const rt::Counter& bad) {
    health_.device_good[at] = good.value();
    health_.device_bad[at++] = bad.value();
  };
  if (health_.device.size() > spare_rods_ + inputs_ + 1) next(stats.valve_good, stats.valve_bad);
  for (std::size_t i = 0; i < spare_rods_; ++i) {
    next(stats.spare_rods[i].good, stats.spare_rods[i].bad);
  }
  for (std::size_t i = 0; i < inputs_; ++i) next(stats.inputs[i].good, stats.inputs[i].bad);
  parts_.publisher.health(health_, stamp());
}

}  // namespace monitor::detection
