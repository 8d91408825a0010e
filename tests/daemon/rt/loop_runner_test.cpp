// From the first tick to the last, in virtual time and on threads: the last thing written is null,
// whatever ends the run, and no sample is lost on the way to the detector.
#include "daemon/rt/loop_runner.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "daemon/detection/detector.h"
#include "tests/daemon/rt/fake_rig.h"

namespace monitor::rt {
namespace {

using control::Event;

/// Everything that a run needs, on the fake rig, sending nothing.
struct RunBench {
  explicit RunBench(Clock& clock_)
      : clock(clock_),
        reference(0.3, 0.0, 0.0),
        loop({}, {clock, rig, &rig, reference, samples, commands, stats},
             control::Controller({100.0}, {kFakeNull_V, 30.0}, kFakeSampleTime_s),
             kFakeSampleTime_s, without_blending()),
        pipeline({}, kFakeSampleTime_s),
        publisher({"", "TEST"}, 1, kFakeSampleTime_s, nullptr),
        detector({clock, samples, stats, pipeline, publisher, nullptr},
                 {"", "", "", "rod", "v", {}, {}, {}}) {
    LoopCommand command;
    command.expires_ns = INT64_MAX;
    for (const Event event : {Event::arm, Event::start}) {
      command.event = event;
      commands.push(command);
    }
    rig.writes.reserve(100000);
  }

  Clock& clock;
  FakeRig rig{nullptr};
  SampleQueue samples;
  CommandQueue commands;
  LoopStats stats;
  control::Sine reference;
  Loop loop;
  estimator::fdi::Pipeline pipeline;
  io::Publisher publisher;
  detection::Detector detector;
  std::atomic<bool> stop{false};
};

TEST(VirtualRun, TicksForItsDurationThenWritesNull) {
  VirtualClock clock;
  RunBench bench(clock);
  {
    rt::LoopRunner runner(bench.loop, Grid(0, kFakePeriod_ns), clock, &bench.rig, 400, bench.stop);
    EXPECT_EQ(run_virtual(runner, bench.detector, bench.stop, [] { return false; }), "");
  }
  EXPECT_EQ(bench.stats.ticks.value(), 401);
  EXPECT_NEAR(bench.rig.writes[399].u_V, kController_V, kRounding_V);
  EXPECT_EQ(bench.rig.writes[400].u_V, kFakeNull_V);
  EXPECT_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
  EXPECT_EQ(clock.now_ns(), 400 * kFakePeriod_ns);
}

TEST(VirtualRun, WritesNullWhenItIsToldToStop) {
  VirtualClock clock;
  RunBench bench(clock);
  int looks = 0;
  rt::LoopRunner runner(bench.loop, Grid(0, kFakePeriod_ns), clock, &bench.rig, kForever,
                        bench.stop);
  EXPECT_EQ(run_virtual(runner, bench.detector, bench.stop, [&] { return ++looks == 4; }), "");
  EXPECT_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
  EXPECT_EQ(bench.stats.state.load(), control::ArmingState::disarmed);
}

TEST(VirtualRun, WritesNullWhenTheDeviceEnds) {
  VirtualClock clock;
  RunBench bench(clock);
  bench.rig.end_tick = 10;
  {
    rt::LoopRunner runner(bench.loop, Grid(0, kFakePeriod_ns), clock, &bench.rig, kForever,
                          bench.stop);
    EXPECT_EQ(run_virtual(runner, bench.detector, bench.stop, [] { return false; }), "");
    EXPECT_NEAR(bench.rig.writes.back().u_V, kController_V, kRounding_V);
  }
  EXPECT_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
}

TEST(VirtualRun, WritesNullWhenAnExceptionPassesThrough) {
  VirtualClock clock;
  RunBench bench(clock);
  try {
    rt::LoopRunner runner(bench.loop, Grid(0, kFakePeriod_ns), clock, &bench.rig, kForever,
                          bench.stop);
    int looks = 0;
    (void)run_virtual(runner, bench.detector, bench.stop, [&]() -> bool {
      if (++looks == 3) throw std::runtime_error("test");
      return false;
    });
    FAIL() << "the exception is lost";
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
}

TEST(RealtimeRun, TicksOnItsOwnThreadAndWritesNullWhenToldToStop) {
  MonotonicClock clock;
  RunBench bench(clock);
  {
    // One millisecond of period: the test is over soon, and the threads meet often.
    rt::LoopRunner runner(bench.loop, Grid(clock.now_ns(), 1'000'000), clock, &bench.rig, kForever,
                          bench.stop);
    EXPECT_EQ(run_realtime(runner, bench.detector, {}, bench.stop, &bench.rig,
                           [&] {
                             clock.sleep_until_ns(clock.now_ns() + 1'000'000);
                             return bench.stats.ticks.value() > 300;
                           }),
              "");
  }
  EXPECT_GT(bench.stats.ticks.value(), 300);
  EXPECT_EQ(bench.rig.writes.back().u_V, kFakeNull_V);
  EXPECT_EQ(bench.samples.read_available(), 0U) << "the detector left samples behind";
}

}  // namespace
}  // namespace monitor::rt
