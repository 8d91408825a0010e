// hal/encoder on a real kernel: lines of gpio-sim, moved in quadrature by a second process.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/encoder/encoder.h"
#include "hal/encoder/gpio_chip.h"
#include "hal/hil_rig/gpio_lines.h"
#include "tests/vm/process.h"

namespace hal::encoder {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using vm::kSecond_ns;
using vm::Process;
using vm::sleep_until;

constexpr double kCount_m = 5e-5;
constexpr Tick kTick;

std::string chip() { return std::getenv("SPOOLWATCH_GPIO_CHIP"); }

std::string table(const std::string& more = "") {
  return "schema_version = 1\nchip = \"" + chip() +
         "\"\nline_a = 2\nline_b = 3\nresolution_m = 5e-5\n" + more;
}

BackendDevices open(const std::string& text) {
  EncoderBackend backend;
  config::schema::Document::parse(text, "rig.toml").read([&](auto& v) { backend.visit(v); });
  return backend.open({"rig.toml", ".", 0.005, 0.0});
}

std::string complaint(const std::string& text) {
  try {
    open(text);
  } catch (const config::schema::Error& e) {
    return e.what();
  }
  return "nothing";
}

const EncoderSnapshot& snapshot(const BackendDevices& devices) {
  return static_cast<EncoderRod&>(*devices.rods.at(kRodChannel)).snapshot();
}

/// The position when nothing has moved for a tenth of a second.
Reading settled(const BackendDevices& devices) {
  sleep_until(monotonic_ns() + kSecond_ns / 10);
  return devices.rods.at(kRodChannel)->read(kTick);
}

/// y in quarters; at most 300 edges a second.
double sine_quarters(double t_s) {
  return 40.0 * std::sin(2.0 * std::numbers::pi * 0.7 * t_s) + 30.0 * t_s;
}

TEST(EncoderVm, FollowsASineExactlyAtAPermittedSpeed) {
  hil_rig::SimEncoder lines(chip(), 2, 3);
  const BackendDevices devices = open(table());
  const std::int64_t start_ns = monotonic_ns();
  constexpr double kEnd_s = 4.0;
  const auto target = [](double t_s) { return std::llround(std::floor(sine_quarters(t_s))); };
  Process driver([&] {
    for (double t_s = 0.0; t_s <= kEnd_s; t_s += 1e-3) {
      sleep_until(start_ns + std::llround(t_s * 1e9));
      lines.move_to(target(t_s));
    }
    return 0;
  });
  double worst_m = 0.0;
  int good = 0;
  for (std::int64_t k = 0; k < 800; ++k) {
    sleep_until(start_ns + k * 5'000'000);
    const Reading reading = devices.rods.at(kRodChannel)->read(kTick);
    if (reading.quality == config::signals::Quality::bad)
      continue;  // the host had stopped the machine
    // The driver may be late by what the machine takes: compare with where it may have been.
    double best_m = 1.0;
    const double t_s = static_cast<double>(reading.t_ns - start_ns) * 1e-9;
    for (double late_s = -0.001; late_s < 0.5; late_s += 1e-3) {
      const double y_m = kCount_m * static_cast<double>(target(std::max(0.0, t_s - late_s)));
      best_m = std::min(best_m, std::abs(reading.y_m - y_m));
    }
    worst_m = std::max(worst_m, best_m);
    EXPECT_NE(reading.quality, config::signals::Quality::uncertain) << k;
    good += reading.quality == config::signals::Quality::good ? 1 : 0;
  }
  EXPECT_EQ(driver.wait(), 0);
  EXPECT_LT(worst_m, 1e-12);
  EXPECT_GT(good, 400);
  EXPECT_NEAR(settled(devices).y_m, kCount_m * static_cast<double>(target(kEnd_s)), 1e-12);
  EXPECT_GT(snapshot(devices).edges, 400);
  EXPECT_EQ(snapshot(devices).illegal, 0);
  EXPECT_EQ(snapshot(devices).times_lost, 0);
}

constexpr std::int64_t kFarthest = 10'000;

/// Up and half way down again as fast as the driver can; edges a second.
double fast_motion(hil_rig::SimEncoder& lines) {
  const std::int64_t start_ns = monotonic_ns();
  Process driver([&] {
    lines.move_to(kFarthest);
    lines.move_to(kFarthest / 2);
    return 0;
  });
  EXPECT_EQ(driver.wait(), 0);
  return 1.5e9 * kFarthest / static_cast<double>(monotonic_ns() - start_ns);
}

TEST(EncoderVm, LosesNoEdgeOfAFastMotionAndPrintsItsRate) {
  hil_rig::SimEncoder unwatched(chip(), 2, 3);
  const double alone_per_s = fast_motion(unwatched);
  hil_rig::SimEncoder lines(chip(), 2, 3);
  const BackendDevices devices = open(table("max_edges_per_s = 1e6"));
  const double rate_per_s = fast_motion(lines);
  const Reading reading = settled(devices);
  const EncoderSnapshot& now = snapshot(devices);
  std::printf(
      "encoder: %.0f edges/s without loss on this machine (the driver of the lines alone: "
      "%.0f edges/s); %lld edges, %lld late\n",
      rate_per_s, alone_per_s, static_cast<long long>(now.edges), static_cast<long long>(now.late));
  EXPECT_NEAR(reading.y_m, kCount_m * kFarthest / 2, 1e-12);
  EXPECT_EQ(now.edges, kFarthest * 3 / 2);
  EXPECT_EQ(now.times_lost, 0);
  EXPECT_EQ(reading.quality, config::signals::Quality::good);
}

TEST(EncoderVm, IsUncertainAboveThePermittedSpeedUntilTheIndex) {
  hil_rig::SimEncoder lines(chip(), 2, 3, 4);
  const BackendDevices devices = open(table("max_edges_per_s = 300.0\nline_index = 4\n"));
  const auto walk_to = [&](std::int64_t to) {  // at most 100 edges a second
    while (lines.quarter() != to) {
      lines.move_to(lines.quarter() + (to > lines.quarter() ? 1 : -1));
      sleep_until(monotonic_ns() + 10'000'000);
    }
    return settled(devices);
  };
  walk_to(5);
  EXPECT_EQ(walk_to(-5).quality, config::signals::Quality::good) << "homed";
  const Reading before = walk_to(10);
  EXPECT_NEAR(before.y_m, kCount_m * 11, 1.1 * kCount_m);
  EXPECT_EQ(before.quality, config::signals::Quality::good);
  lines.move_to(60);
  const Reading fast = settled(devices);
  EXPECT_NEAR(fast.y_m, before.y_m + kCount_m * 50, 1e-12) << "nothing was lost, as it happens";
  EXPECT_EQ(fast.quality, config::signals::Quality::uncertain);
  EXPECT_GE(snapshot(devices).bursts, 1);
  EXPECT_GE(snapshot(devices).times_too_fast, 1);
  EXPECT_EQ(walk_to(10).quality, config::signals::Quality::uncertain);
  const Reading after = walk_to(-5);
  EXPECT_EQ(after.quality, config::signals::Quality::good);
  EXPECT_EQ(snapshot(devices).slips, 0);
}

TEST(EncoderVm, SaysThatTheCountIsUncertainWhenTheKernelDropsEdgesAndTheIndexMendsIt) {
  hil_rig::SimEncoder lines(chip(), 2, 3, 4);
  lines.move_to(-20);
  // The lines are watched, but for a while nobody fetches their edges.
  const auto gpio = GpioChip::open("test", chip());
  const auto line = [&](int offset) { return gpio->request("test", offset, Use::edges, {}); };
  GpioSource source(line(2), line(3), line(4));
  Tracker tracker({4, 1e6, true}, still_levels(source));
  const auto step = [&] {
    for (int i = 0; i < 20; ++i) tracker.step(source, 1'000'000, monotonic_ns);
    return tracker.snapshot();
  };
  step();
  lines.move_to(10);
  const EncoderSnapshot before = step();
  EXPECT_TRUE(before.homed);
  EXPECT_FALSE(before.lost) << "15 edges a line";
  EXPECT_EQ(before.counts, 10);
  lines.move_to(110);
  const EncoderSnapshot lost = step();
  EXPECT_TRUE(lost.lost);
  EXPECT_GE(lost.overflows, 1);
  EXPECT_NE(lost.counts, 110) << "the newest were dropped";
  while (lines.quarter() > -10) {
    lines.move_to(lines.quarter() - 5);
    step();
  }
  const EncoderSnapshot mended = step();
  EXPECT_FALSE(mended.lost);
  EXPECT_EQ(mended.slips, 1);
  EXPECT_NEAR(static_cast<double>(mended.counts), -10.0, 1.0);
}

/// The level that the chip's line is driven to, from its value file: "0" or "1".
char driven(int line) {
  const std::string pattern =
      "/sys/devices/platform/gpio-sim.0/" + chip() + "/sim_gpio" + std::to_string(line) + "/value";
  std::FILE* file = std::fopen(pattern.c_str(), "r");
  const int value = file == nullptr ? '?' : std::fgetc(file);
  if (file != nullptr) std::fclose(file);
  return static_cast<char>(value);
}

TEST(EncoderVm, ReadsSwitchesAndSetsThePermitLine) {
  hil_rig::SimLine high(chip(), 6);
  hil_rig::SimLine low(chip(), 7);
  high.set(true);
  low.set(true);
  const BackendDevices devices =
      open(table("[[input]]\nname = \"e_stop\"\nline = 6\n[[input]]\nname = \"enable\"\nline = 7\n"
                 "active_low = true\n[[output]]\nname = \"permit\"\nline = 8\n"));
  sleep_until(monotonic_ns() + kSecond_ns / 50);
  Input& e_stop = *devices.inputs.at("e_stop");
  Input& enable = *devices.inputs.at("enable");
  EXPECT_EQ(e_stop.read(kTick).value, 1.0);
  EXPECT_EQ(e_stop.read(kTick).quality, config::signals::Quality::good);
  EXPECT_EQ(enable.read(kTick).value, 0.0) << "active low";
  high.set(false);
  low.set(false);
  sleep_until(monotonic_ns() + kSecond_ns / 50);
  EXPECT_EQ(e_stop.read(kTick).value, 0.0);
  EXPECT_EQ(enable.read(kTick).value, 1.0);
  Output& permit = *devices.outputs.at("permit");
  EXPECT_EQ(driven(8), '0') << "off until it is set";
  for (const bool on : {true, false, true}) {
    EXPECT_TRUE(permit.set(on));
    EXPECT_EQ(driven(8), on ? '1' : '0');
  }
}

TEST(EncoderVm, RefusesLinesThatItCannotHave) {
  const BackendDevices held = open(table());
  EXPECT_THAT(complaint(table()),
              AllOf(HasSubstr("[encoder] line_a"), HasSubstr("in use by \"spoolwatch\"")));
  EXPECT_THAT(complaint("schema_version = 1\nchip = \"" + chip() +
                        "\"\nline_a = 5\nline_b = 16\nresolution_m = 5e-5\n"),
              AllOf(HasSubstr("[encoder] line_b"), HasSubstr("lines 0 to 15")));
  EXPECT_THAT(complaint("schema_version = 1\nchip = \"gpiochip9\"\nline_a = 5\nline_b = 6\n"
                        "resolution_m = 5e-5\n"),
              AllOf(HasSubstr("[encoder] chip"), HasSubstr(chip() + " (rig)")));
}

}  // namespace
}  // namespace hal::encoder
