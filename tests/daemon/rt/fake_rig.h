// A rig made of two numbers and a list: what the loop reads is set by the test, what it writes is
// kept. Reading or writing may take virtual time, or fail.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "daemon/rt/loop.h"

namespace monitor::rt {

inline constexpr double kFakeNull_V = 0.4;
inline constexpr double kFakeSampleTime_s = 0.005;
inline constexpr std::int64_t kFakePeriod_ns = 5'000'000;

class FakeRig final : public hal::RodSensor, public hal::ValveDrive {
 public:
  struct Write {
    std::int64_t tick;
    double u_V;
  };

  explicit FakeRig(VirtualClock* clock) : clock_(clock) {}

  hal::Reading read(const hal::Tick& tick) noexcept override {
    if (clock_ != nullptr) clock_->advance_ns(read_ns);
    hal::Reading reading;
    reading.end = tick.index >= end_tick;
    reading.y_m = y_m;
    reading.t_ns = t_ns;
    reading.command_V = command_V;
    reading.quality = quality;
    reading.saturated = command_saturated;
    tick_ = tick.index;
    return reading;
  }
  hal::Applied write(double u_V, const hal::Tick& tick) noexcept override {
    writes.push_back({tick.index, u_V});
    return {u_V, write_good};
  }
  hal::Applied go_null() noexcept override { return write(kFakeNull_V, {tick_, 0}); }

  double y_m = 0.1;
  double command_V = hal::kMissing;
  config::signals::Quality quality = config::signals::Quality::good;
  bool command_saturated = false;
  bool write_good = true;
  std::int64_t read_ns = 0;
  std::int64_t t_ns = 0;  ///< when the reading was measured, 0: not known
  std::int64_t end_tick = kForeverTicks;
  std::vector<Write> writes;

  static constexpr std::int64_t kForeverTicks = 1'000'000'000;

 private:
  VirtualClock* clock_;
  std::int64_t tick_ = 0;
};

/// The value set last, and how often it changed.
class FakeOutput final : public hal::Output {
 public:
  bool set(bool level) noexcept override {
    edges += level != on ? 1 : 0;
    on = level;
    return true;
  }
  bool on = false;
  int edges = 0;
};

/// An input that the test sets.
class FakeInput final : public hal::Input {
 public:
  explicit FakeInput(double value_) : value(value_) {}
  hal::InputReading read(const hal::Tick&) noexcept override { return {value, 0, quality}; }
  double value;
  config::signals::Quality quality = config::signals::Quality::good;
};

/// No guards but the built-in ones, and the signal at once.
inline SafetyRules without_blending() {
  SafetyRules rules;
  rules.safety.blend_s = 0.0;
  return rules;
}

/// A loop on the fake rig in virtual time: reference 0.3 m, 100 V/m, no slew limit.
class LoopBench {
 public:
  explicit LoopBench(const LoopConfig& config = {}, bool with_valve = true,
                     const SafetyRules& rules = without_blending())
      : reference_(0.3, 0.0, 0.0),
        controller_({100.0}, {kFakeNull_V, 30.0}, kFakeSampleTime_s),
        loop_(config,
              {clock, rig, with_valve ? &rig : nullptr, reference_, samples, commands, stats,
               &spare_rods, &inputs, &permit},
              controller_, kFakeSampleTime_s, rules),
        grid_(0, kFakePeriod_ns) {}

  bool tick() { return loop_.tick(grid_.next(clock)); }
  /// Ticks once and returns its sample.
  config::signals::Sample sample() {
    tick();
    config::signals::Sample last;
    while (samples.pop(last)) {
    }
    return last;
  }
  void command(control::Event event, std::int64_t life_ns = 1'000'000'000) {
    LoopCommand next;
    next.event = event;
    next.expires_ns = clock.now_ns() + life_ns;
    commands.push(next);
  }
  void run() {
    command(control::Event::arm);
    command(control::Event::start);
    tick();
  }
  Loop& loop() { return loop_; }
  [[nodiscard]] double last_V() const { return rig.writes.back().u_V; }
  [[nodiscard]] control::ArmingState state() const { return stats.state.load(); }

  VirtualClock clock;
  FakeRig rig{&clock};
  std::vector<hal::NamedRod> spare_rods;  ///< to be filled before the first tick
  std::vector<hal::NamedInput> inputs;    ///< likewise
  FakeOutput permit;
  SampleQueue samples;
  CommandQueue commands;
  LoopStats stats;

 private:
  control::Sine reference_;
  control::Controller controller_;
  Loop loop_;
  Grid grid_;
};

/// Orders and returns what the loop answers in the next tick.
inline control::CommandAnswer ask(LoopBench& bench, control::Event event,
                                  std::uint32_t number = 7) {
  LoopCommand command;
  command.event = event;
  command.number = number;
  command.expires_ns = INT64_MAX;
  bench.commands.push(command);
  bench.tick();
  const control::CommandAnswer answer = control::unpack(bench.stats.answer.load());
  EXPECT_EQ(answer.number, number);
  EXPECT_EQ(answer.state, bench.state());
  return answer;
}

/// The controller's command with the rod at 0.1 m.
inline constexpr double kController_V = kFakeNull_V + 100.0 * (0.3 - 0.1);
inline constexpr double kRounding_V = 1e-12;

}  // namespace monitor::rt
