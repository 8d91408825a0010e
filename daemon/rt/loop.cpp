#include "daemon/rt/loop.h"

#include <algorithm>
#include <cmath>

namespace monitor::rt {

using config::signals::Sample;
using control::Action;
using control::ArmingState;
using control::Event;
using control::GuardKind;
using control::RejectReason;

void LoopConfig::visit(config::schema::Visitor& v) {
  v.number({"rate_hz", "loop rate; a replayed record determines its own"}, rate_Hz, {1.0, 2000.0});
  v.boolean({"auto_arm", "arm and start automatically; only without real devices"}, auto_arm);
  v.integer({"max_lost_in_a_row", "periods lost in a row before overrun_action"}, max_lost_in_a_row,
            {0, 1000000});
  v.integer({"max_lost_a_minute", "periods lost within 60 s before overrun_action"},
            max_lost_a_minute, {0, kMaxOverrunsAMinute});
  v.choice({"overrun_action", "action when more periods are lost"}, overrun_action,
           {"count", "disarm", "latch"});
  v.integer({"max_bad_in_a_row", "missing readings or failed writes in a row before a trip"},
            max_bad_in_a_row, {0, 1000});
  v.choice({"privileges", "real-time scheduling and locked memory"}, privileges,
           {"require", "try", "off"});
  v.integer({"priority", "SCHED_FIFO priority"}, priority, {1, 99});
  v.integer({"cpu", "CPU that the loop is pinned to, -1 for any"}, cpu, {-1, 1023});
}

control::Action LoopConfig::overrun() const noexcept {
  return overrun_action == "latch"    ? Action::latch
         : overrun_action == "disarm" ? Action::disarm
                                      : Action::indicate;
}

Loop::Loop(const LoopConfig& config, const Parts& parts, const control::Controller& controller,
           double sample_time_s, const SafetyRules& rules)
    : parts_(parts),
      controller_(controller),
      reference_(parts.reference, {rules.safety.blend_s, rules.safety.blend_mps, sample_time_s}),
      ramp_(rules.safety.ramp_s),
      guard_monitor_(control::all_guards(rules.safety, config.overrun()), sample_time_s),
      arming_(parts.valve == nullptr),
      position_sensor_(parts.rod, parts.spare_rods, parts.stats,
                       {rules.safety.failover,
                        control::all_guards(rules.safety, config.overrun()),
                        {sample_time_s, config.max_bad_in_a_row, rules.safety.blend_mps}}),
      aux_inputs_(parts.inputs, config.max_bad_in_a_row, parts.stats),
      overruns_(config.max_lost_in_a_row, config.max_lost_a_minute),
      sample_time_s_(sample_time_s),
      null_V_(controller.null_V()),
      max_bad_in_a_row_(config.max_bad_in_a_row),
      may_arm_(rules.may_arm) {
  parts_.stats.state.store(arming_.state(), std::memory_order_relaxed);
}

void Loop::apply(Event event) noexcept {
  if (!arming_.apply(event)) return;
  if (arming_.state() != ArmingState::run) ramp_.stop();
  if (event == Event::reset) parts_.stats.trip.store(Trip::none, std::memory_order_relaxed);
  parts_.stats.state.store(arming_.state(), std::memory_order_relaxed);
}

void Loop::act(const control::GuardTrip& trip, bool measured) noexcept {
  const ArmingState state = arming_.state();
  if (state != ArmingState::run && (measured || state != ArmingState::armed)) return;
  switch (trip.action) {
    case Action::none:
    case Action::indicate:
      break;
    case Action::hold:
      if (state == ArmingState::run && have_position()) reference_.hold(y_m_);
      break;
    case Action::ramp:
      if (state == ArmingState::armed) leave();
      if (state == ArmingState::run && !ramp_.active()) ramp_.start(last_V_, time_s());
      break;
    case Action::disarm:
      leave();
      break;
    case Action::latch:
      latch(trip.guard);
      break;
  }
}

void Loop::latch(int guard) noexcept {
  const auto kind = static_cast<GuardKind>(guard);
  const bool unread =
      kind == GuardKind::missing || (kind == GuardKind::e_stop && aux_inputs_.e_stop_unread());
  unread_latch_tick_ = unread ? tick_ : -1;
  set_trip(guard);
  apply(Event::trip);
}

void Loop::set_trip(int guard) noexcept {
  constexpr Trip kBuiltInTrips[] = {Trip::e_stop, Trip::reading, Trip::write, Trip::overrun};
  const auto index = static_cast<std::size_t>(guard);
  Trip trip = index < control::kBuiltIn ? kBuiltInTrips[index] : Trip::guard;
  if (trip == Trip::e_stop && aux_inputs_.e_stop_unread()) trip = Trip::e_stop_unread;
  parts_.stats.trip_guard.store(static_cast<std::uint8_t>(guard), std::memory_order_relaxed);
  parts_.stats.trip.store(trip, std::memory_order_relaxed);
}

void Loop::leave() noexcept {
  if (arming_.state() == ArmingState::run || arming_.state() == ArmingState::armed)
    apply(Event::disarm);
}

RejectReason Loop::obstacle(Event event) const noexcept {
  if (event != Event::arm && event != Event::start) return RejectReason::none;
  if (closing_) return RejectReason::closing;
  if (!may_arm_) return RejectReason::calibration;
  if (!aux_inputs_.enabled()) return RejectReason::enable;
  if (guard_monitor_.obstacle() >= 0) return RejectReason::guard;
  return event == Event::start && !have_position() ? RejectReason::position : RejectReason::none;
}

RejectReason Loop::carry_out(Event event, bool at_once) noexcept {
  if (arming_.state() == ArmingState::monitor) return RejectReason::monitor;
  control::Arming after = arming_;
  const bool resume =
      event == Event::start && arming_.state() == ArmingState::run && reference_.holding();
  if (!resume && !after.apply(event)) return RejectReason::state;
  if (const RejectReason reject_reason = obstacle(event); reject_reason != RejectReason::none)
    return reject_reason;
  if (event == Event::start) {
    reference_.start(y_m_, tick_, at_once);
    guard_monitor_.start(y_m_);
    position_sensor_.voter().start();
    if (!resume) controller_.reset();
  }
  if (!resume) apply(event);
  return RejectReason::none;
}

void Loop::take(GuardUpdate& update, bool expired) noexcept {
  using Outcome = GuardUpdate::Outcome;
  const bool begun = update.begin();
  const bool armed = arming_.state() == ArmingState::armed || arming_.state() == ArmingState::run;
  const Outcome outcome = expired || !begun         ? Outcome::expired
                          : armed && update.loosens ? Outcome::armed
                                                    : Outcome::applied;
  if (outcome == Outcome::applied) {
    guard_monitor_.take_limits(update.guards);
    position_sensor_.voter().take_limits(update.guards);
  }
  update.outcome.store(outcome, std::memory_order_release);
}

RejectReason Loop::carry_out(const LoopCommand& command) noexcept {
  const bool expired = parts_.clock.now_ns() >= command.expires_ns;
  if (command.kind == LoopCommand::Kind::guards) take(*command.guards, expired);
  if (expired) {
    parts_.stats.expired_commands.add();
    return RejectReason::expired;
  }
  if (command.kind == LoopCommand::Kind::guards) return RejectReason::none;
  if (command.kind == LoopCommand::Kind::readmit) {
    position_sensor_.voter().readmit();
    return RejectReason::none;
  }
  if (command.kind == LoopCommand::Kind::event) return carry_out(command.event, command.at_once);
  if (arming_.state() == ArmingState::monitor) return RejectReason::monitor;
  const bool run = arming_.state() == ArmingState::run && !ramp_.active();
  if (run && !have_position()) return RejectReason::position;
  if (command.kind == LoopCommand::Kind::hold) {
    if (!run) return RejectReason::state;
    reference_.hold(y_m_);
    return RejectReason::none;
  }
  // Re-arms the guards, so that a held reference can be held again.
  if (run) guard_monitor_.start(y_m_);
  reference_.follow(control::Sine(command.centre_m, command.amplitude_m, command.frequency_Hz),
                    tick_, run);
  return RejectReason::none;
}

void Loop::take_commands() noexcept {
  LoopCommand command;
  while (parts_.commands.pop(command)) {
    const RejectReason reject_reason = carry_out(command);
    if (reject_reason != RejectReason::none && reject_reason != RejectReason::expired) {
      parts_.stats.rejected_commands.add();
    }
    if (command.number == 0) continue;
    answer_ = {command.number, reject_reason, arming_.state(), 0};
    if (reject_reason == RejectReason::guard)
      answer_.guard = static_cast<std::uint8_t>(guard_monitor_.obstacle());
  }
}

void Loop::watch_inputs(const hal::Tick& tick) noexcept {
  aux_inputs_.read(tick);
  act(guard_monitor_.set(GuardKind::e_stop, !aux_inputs_.e_stop_released(), 0.0), false);
  if (!aux_inputs_.enabled()) leave();
  const bool missing = bad_readings_ > max_bad_in_a_row_;
  act(guard_monitor_.set(GuardKind::missing, missing, static_cast<double>(bad_readings_)), false);
}

void Loop::watch_overruns(const Period& period) noexcept {
  if (period.skipped > 0) {
    parts_.stats.overruns.add();
    parts_.stats.skipped_periods.add(period.skipped);
    parts_.stats.lateness.add(period.overrun_ns);
    gap_ += period.skipped;
  }
  const bool too_many = overruns_.add(period.skipped, period.tick.nominal_ns);
  act(guard_monitor_.set(GuardKind::overrun, too_many, static_cast<double>(period.skipped)), false);
}

void Loop::watch_motion(const hal::Reading& reading, Sample& sample) noexcept {
  const bool follows = arming_.state() == ArmingState::run && !ramp_.active();
  if (follows && interrupted_ && have_position()) reference_.resume_from(y_m_, tick_);
  if (follows) sample.reference_m = reference_.at(tick_);
  control::GuardInputs inputs;
  inputs.t_s = time_s();
  inputs.y_m = y_m_;
  inputs.called_stale = reading.t_ns == 0 && reading.quality == config::signals::Quality::stale;
  if (reading.t_ns != 0) {
    inputs.age_s = static_cast<double>(parts_.clock.now_ns() - reading.t_ns) * 1e-9;
  }
  inputs.reference_m = sample.reference_m;
  inputs.command_V = last_V_;
  inputs.saturated = last_limited_;
  inputs.spare_difference_m = position_sensor_.voter().difference_m();
  inputs.pressures = aux_inputs_.pressures();
  inputs.other_sensor = position_sensor_.voter().changed();
  act(guard_monitor_.watch(inputs, position_sensor_.voter().watch()), true);
  if (follows && reference_.holding()) sample.reference_m = reference_.at(tick_);
}

void Loop::drive(const Period& period, Sample& sample) noexcept {
  const std::int64_t start_ns = parts_.clock.now_ns();
  const std::int64_t period_ns = std::llround(sample_time_s_ * 1e9);
  const bool too_long = period.skipped > 0 && (period.skipped + 1) * period_ns >= kNullAfter_ns;
  if (ramp_.active() && (too_long || ramp_.over(time_s()))) leave();
  const bool run = arming_.state() == ArmingState::run && !too_long;
  const bool ramp = run && ramp_.active();
  const bool controlling = run && !ramp && have_position() && !aux_inputs_.blind();
  double command_V = null_V_;
  if (controlling) {
    const int periods = static_cast<int>(std::min<std::int64_t>(period.skipped + 1, 1000));
    const control::ValveCommand command =
        controller_.update(sample.reference_m, y_m_ + position_sensor_.voter().bump_m(), periods);
    sample.u_requested_V = command.requested_V;
    sample.saturated = command.saturated;
    command_V = command.limited_V;
  } else {
    controller_.reset();
    if (ramp) command_V = sample.u_requested_V = null_V_ + ramp_.at(time_s());
  }
  interrupted_ = arming_.state() == ArmingState::run && !controlling && !ramp;
  last_V_ = command_V - null_V_;
  last_limited_ = sample.saturated;
  sample.t_write_ns = parts_.clock.now_ns();
  parts_.stats.control.add(sample.t_write_ns - start_ns);
  const hal::Applied applied =
      controlling || ramp ? parts_.valve->write(command_V, period.tick) : parts_.valve->go_null();
  parts_.stats.write.add(parts_.clock.now_ns() - sample.t_write_ns);
  sample.u_applied_V = applied.u_V;
  (applied.good ? parts_.stats.valve_good : parts_.stats.valve_bad).add();
  bad_writes_ = applied.good ? 0 : bad_writes_ + 1;
  const bool lost = bad_writes_ > max_bad_in_a_row_;
  act(guard_monitor_.set(GuardKind::bus_lost, lost, static_cast<double>(bad_writes_)), false);
  // A lost bus shows first in what cannot be read.
  if (lost && unread_latch_tick_ >= 0 && tick_ - unread_latch_tick_ <= max_bad_in_a_row_ + 1) {
    if (arming_.state() == ArmingState::latched) set_trip(static_cast<int>(GuardKind::bus_lost));
    unread_latch_tick_ = -1;
  }
}

void Loop::send(Sample& sample) noexcept {
  sample.gap = static_cast<std::int32_t>(std::min<std::int64_t>(gap_, INT32_MAX));
  if (parts_.samples.push(sample)) {
    gap_ = 0;
  } else {
    ++gap_;
    parts_.stats.dropped_samples.add();
  }
}

void Loop::publish_stats(const Period& period, const Sample& sample) noexcept {
  LoopStats& stats = parts_.stats;
  const bool run = arming_.state() == ArmingState::run;
  stats.guards.update(guard_monitor_);
  stats.y_m.store(sample.y_m, std::memory_order_relaxed);
  stats.u_V.store(sample.u_applied_V, std::memory_order_relaxed);
  stats.reference_m.store(sample.reference_m, std::memory_order_relaxed);
  stats.holding.store(run && reference_.holding(), std::memory_order_relaxed);
  stats.ramping.store(run && ramp_.active(), std::memory_order_relaxed);
  answer_.state = arming_.state();
  stats.answer.store(control::pack(answer_), std::memory_order_release);
  const bool good = arming_.state() != ArmingState::latched && period.skipped == 0 && !closing_;
  if (parts_.permit == nullptr || !good) return;
  permit_on_ = !permit_on_;
  (parts_.permit->set(permit_on_) ? stats.permit_good : stats.permit_bad).add();
}

bool Loop::tick(const Period& period) noexcept {
  const std::int64_t start_ns = parts_.clock.now_ns();
  tick_ = period.tick.index;
  parts_.stats.lateness.add(period.lateness_ns);

  Sample sample;
  sample.tick = tick_;
  sample.utc_us = parts_.clock.utc_us();
  sample.t_read_ns = parts_.clock.now_ns();
  const bool follows = arming_.state() == ArmingState::run && !ramp_.active() && !interrupted_;
  const hal::Reading& reading =
      position_sensor_.read(period.tick, parts_.clock, time_s(), last_V_, follows);
  parts_.stats.read.add(parts_.clock.now_ns() - sample.t_read_ns);
  if (reading.end) return false;

  const bool good = hal::trusted(reading.quality, reading.y_m);
  bad_readings_ = good ? 0 : bad_readings_ + 1;
  y_m_ = good ? reading.y_m : hal::kMissing;
  sample.y_m = y_m_;
  sample.quality = good ? reading.quality : config::signals::Quality::bad;
  position_sensor_.fill(sample);
  watch_inputs(period.tick);
  sample.pressures = aux_inputs_.pressures();
  take_commands();
  watch_overruns(period);
  if (closing_) leave();

  sample.reference_m = hal::kMissing;
  sample.u_requested_V = hal::kMissing;
  sample.u_applied_V = aux_inputs_.has_command() ? aux_inputs_.command_V() : reading.command_V;
  watch_motion(reading, sample);
  if (parts_.valve != nullptr) {
    drive(period, sample);
  } else {
    sample.saturated = reading.saturated;
    last_V_ = sample.u_applied_V;
    last_limited_ = reading.saturated;
  }
  sample.state = static_cast<std::uint8_t>(arming_.state());
  send(sample);
  publish_stats(period, sample);
  parts_.stats.ticks.add();
  parts_.stats.tick.add(parts_.clock.now_ns() - start_ns);
  return true;
}

}  // namespace monitor::rt
