#include "estimator/fdi/band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace estimator::fdi {
namespace {

BandConfig example() {
  BandConfig band;
  band.id = "example";
  band.low = 1.0;
  band.high = 2.0;
  band.hysteresis = 0.1;
  band.on_delay_s = 0.5;
  band.off_delay_s = 1.0;
  return band;
}

struct Step {
  double t_s;
  double value;  // NaN: not trustworthy
  Severity severity;
  int direction;
};

void follow(BandState& state, const std::vector<Step>& steps) {
  for (const Step& step : steps) {
    const BandState::Result result = state.update(step.value, step.t_s);
    EXPECT_EQ(result.severity, step.severity) << "at " << step.t_s << " s";
    EXPECT_EQ(result.direction, step.direction) << "at " << step.t_s << " s";
  }
}

constexpr Severity kOk = Severity::ok;
constexpr Severity kMajor = Severity::major;
constexpr Severity kInvalid = Severity::invalid;
const double kNan = std::nan("");

TEST(Band, ComesAfterTheOnDelayAndGoesAfterTheOffDelayBeyondTheHysteresis) {
  BandState state(example());
  follow(state, {{0.00, 1.50, kOk, 0},
                 {0.25, 2.10, kOk, 0},
                 {0.50, 2.10, kOk, 0},
                 {0.75, 2.10, kMajor, 1},  // outside since 0.25 s
                 {1.00, 1.95, kMajor, 1},  // inside, but within the hysteresis
                 {1.25, 1.85, kMajor, 1},  // the off-delay starts
                 {1.50, 1.95, kMajor, 1},  // and is broken off
                 {1.75, 1.85, kMajor, 1},  // and starts again
                 {2.50, 1.85, kMajor, 1},
                 {2.75, 1.85, kOk, 0}});
}

TEST(Band, ForgetsAnExcursionShorterThanTheOnDelay) {
  BandState state(example());
  follow(state, {{0.00, 0.90, kOk, 0},
                 {0.25, 1.50, kOk, 0},
                 {0.50, 0.90, kOk, 0},
                 {0.75, 0.90, kOk, 0},
                 {1.00, 0.90, kMajor, -1}});
}

TEST(Band, GoesFromOneSideToTheOtherAfterTheOnDelay) {
  BandState state(example());
  follow(state, {{0.00, 0.90, kOk, 0},
                 {0.50, 0.90, kMajor, -1},
                 {0.75, 2.50, kMajor, -1},
                 {1.00, 2.50, kMajor, -1},
                 {1.25, 2.50, kMajor, 1}});
}

/// A log read again, a rig restarted: what was pending counts from the new time.
TEST(Band, KeepsItsDelaysWhenTimeGoesBack) {
  BandState on(example());
  follow(on, {{100.0, 2.50, kOk, 0}, {1.0, 2.50, kOk, 0}, {1.5, 2.50, kMajor, 1}});
  BandConfig late = example();
  late.invalid_delay_s = 0.3;
  BandState invalid(late);
  follow(invalid, {{100.0, kNan, kOk, 0}, {1.0, kNan, kOk, 0}, {1.3, kNan, kInvalid, 0}});
}

TEST(Band, WithoutDelaysActsAtOnce) {
  BandConfig config = example();
  config.on_delay_s = 0.0;
  config.off_delay_s = 0.0;
  config.severity = "minor";
  BandState state(config);
  follow(state, {{0.0, 2.01, Severity::minor, 1}, {0.1, 1.89, kOk, 0}});
}

TEST(Band, TurnsInvalidAfterItsDelayAndKeepsTheAlarmUnderneath) {
  BandConfig config = example();
  config.on_delay_s = 0.0;
  config.invalid_delay_s = 0.5;
  BandState state(config);
  follow(state, {{0.00, 2.50, kMajor, 1},
                 {0.25, kNan, kMajor, 1},
                 {0.50, kNan, kMajor, 1},
                 {0.75, kNan, kInvalid, 0},
                 {1.00, kNan, kInvalid, 0},
                 {1.25, 2.50, kMajor, 1}});
}

TEST(Band, CountsTheInvalidDelayFromTheLastTrustworthyValue) {
  BandConfig config = example();
  config.invalid_delay_s = 0.5;
  BandState state(config);
  follow(state, {{0.00, kNan, kOk, 0},
                 {0.25, 1.50, kOk, 0},
                 {0.50, kNan, kOk, 0},
                 {0.75, kNan, kOk, 0},
                 {1.00, kNan, kInvalid, 0}});
}

}  // namespace
}  // namespace estimator::fdi
