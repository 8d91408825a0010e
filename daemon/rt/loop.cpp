#include "daemon/rt/loop.h"

#include <algorithm>
#include <cmath>

namespace monitor::rt {

using control::Event;
using control::State;
using estimator::fdi::Sample;

void LoopConfig::visit(config::schema::Visitor& v) {
  v.number({"rate_hz", "of the loop; a replayed record brings its own"}, rate_Hz, {1.0, 2000.0});
  v.boolean({"auto_arm", "arm and start by itself; only where nothing real moves"}, auto_arm);
  v.integer({"max_lost_in_a_row", "periods lost without a good tick between"}, max_lost_in_a_row,
            {0, 1000000});
  v.integer({"max_lost_a_minute", "periods lost within 60 s"}, max_lost_a_minute,
            {0, kMaxOverrunsAMinute});
  v.choice({"overrun_action", "what more than that leads to"}, overrun_action,
           {"count", "disarm", "latch"});
  v.integer({"max_bad_in_a_row", "missing readings or failed writes before a trip"},
            max_bad_in_a_row, {0, 1000});
  v.choice({"privileges", "real-time scheduling and locked memory"}, privileges,
           {"require", "try", "off"});
  v.integer({"priority", "of SCHED_FIFO"}, priority, {1, 99});
  v.integer({"cpu", "core that the loop is pinned to, -1 for any"}, cpu, {-1, 1023});
}

Loop::Loop(const LoopConfig& config, const Parts& parts, const control::Controller& controller,
           double sample_time_s) noexcept
    : parts_(parts),
      controller_(controller),
      reference_(&parts.reference),
      arming_(parts.valve == nullptr),
      overruns_(config.max_lost_in_a_row, config.max_lost_a_minute),
      overrun_action_(config.overrun_action == "latch"    ? OverrunAction::latch
                      : config.overrun_action == "disarm" ? OverrunAction::disarm
                                                          : OverrunAction::count),
      sample_time_s_(sample_time_s),
      max_bad_in_a_row_(config.max_bad_in_a_row) {
  parts_.stats.state.store(arming_.state(), std::memory_order_relaxed);
}

void Loop::apply(Event event) noexcept {
  if (!arming_.apply(event)) {
    parts_.stats.refused_commands.add();
    return;
  }
  if (event == Event::start) {
    motion_tick_ = tick_;
    controller_.reset();
  }
  if (event == Event::reset) parts_.stats.trip.store(Trip::none, std::memory_order_relaxed);
  parts_.stats.state.store(arming_.state(), std::memory_order_relaxed);
}

void Loop::trip(Trip why) noexcept {
  if (arming_.state() == State::monitor || arming_.state() == State::latched) return;
  parts_.stats.trip.store(why, std::memory_order_relaxed);
  apply(Event::trip);
}

void Loop::take_commands() noexcept {
  Command command;
  while (parts_.commands.pop(command)) {
    if (parts_.clock.now_ns() >= command.expires_ns) {
      parts_.stats.expired_commands.add();
    } else if (command.kind == Command::Kind::event) {
      apply(command.event);
    } else {
      commanded_ = control::Sine(command.centre_m, command.amplitude_m, command.frequency_Hz);
      reference_ = &commanded_;
      motion_tick_ = tick_;
    }
  }
}

void Loop::watch_overruns(const Period& period) noexcept {
  if (period.skipped > 0) {
    parts_.stats.overruns.add();
    parts_.stats.skipped_periods.add(period.skipped);
    parts_.stats.lateness.add(period.overrun_ns);
    gap_ += period.skipped;
  }
  if (!overruns_.add(period.skipped, period.tick.nominal_ns)) return;
  if (overrun_action_ == OverrunAction::latch) trip(Trip::overrun);
  if (overrun_action_ == OverrunAction::disarm) leave();
}

void Loop::leave() noexcept {
  if (arming_.state() == State::run || arming_.state() == State::armed) apply(Event::disarm);
}

void Loop::watch_device(bool good, std::int64_t& bad_in_a_row, Trip why) noexcept {
  bad_in_a_row = good ? 0 : bad_in_a_row + 1;
  if (bad_in_a_row > max_bad_in_a_row_) trip(why);
}

void Loop::drive(const Period& period, bool have_position, Sample& sample) noexcept {
  const std::int64_t start_ns = parts_.clock.now_ns();
  const std::int64_t period_ns = std::llround(sample_time_s_ * 1e9);
  const bool too_long = period.skipped > 0 && (period.skipped + 1) * period_ns >= kNullAfter_ns;
  const bool run = arming_.state() == State::run && have_position && !too_long;
  double limited_V = 0.0;
  if (arming_.state() == State::run) {
    sample.reference_m = reference_->at(static_cast<double>(tick_ - motion_tick_) * sample_time_s_);
  }
  if (run) {
    const int periods = static_cast<int>(std::min<std::int64_t>(period.skipped + 1, 1000));
    const control::Command command = controller_.update(sample.reference_m, sample.y_m, periods);
    sample.u_requested_V = command.requested_V;
    sample.saturated = command.saturated;
    limited_V = command.limited_V;
  } else {
    controller_.reset();
  }
  sample.t_write_ns = parts_.clock.now_ns();
  parts_.stats.control.add(sample.t_write_ns - start_ns);
  const hal::Applied applied =
      run ? parts_.valve->write(limited_V, period.tick) : parts_.valve->go_null();
  parts_.stats.write.add(parts_.clock.now_ns() - sample.t_write_ns);
  sample.u_applied_V = applied.u_V;
  (applied.good ? parts_.stats.valve_good : parts_.stats.valve_bad).add();
  watch_device(applied.good, bad_writes_, Trip::write);
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

bool Loop::tick(const Period& period) noexcept {
  const std::int64_t start_ns = parts_.clock.now_ns();
  tick_ = period.tick.index;
  parts_.stats.lateness.add(period.lateness_ns);
  take_commands();
  watch_overruns(period);
  if (closing_) leave();

  Sample sample;
  sample.tick = tick_;
  sample.utc_us = parts_.clock.utc_us();
  sample.t_read_ns = parts_.clock.now_ns();
  const hal::Reading reading = parts_.rod.read(period.tick);
  parts_.stats.read.add(parts_.clock.now_ns() - sample.t_read_ns);
  if (reading.end) return false;

  const bool have_position = reading.quality != hal::Quality::bad && std::isfinite(reading.y_m);
  (have_position ? parts_.stats.rod_good : parts_.stats.rod_bad).add();
  watch_device(have_position, bad_readings_, Trip::reading);
  sample.y_m = have_position ? reading.y_m : hal::kMissing;
  sample.quality = have_position ? static_cast<estimator::fdi::Quality>(reading.quality)
                                 : estimator::fdi::Quality::bad;
  sample.reference_m = hal::kMissing;
  sample.u_requested_V = hal::kMissing;
  sample.u_applied_V = reading.command_V;
  sample.saturated = reading.saturated;
  if (parts_.valve != nullptr) drive(period, have_position, sample);
  sample.state = static_cast<std::uint8_t>(arming_.state());
  send(sample);
  parts_.stats.ticks.add();
  parts_.stats.tick.add(parts_.clock.now_ns() - start_ns);
  return true;
}

}  // namespace monitor::rt
