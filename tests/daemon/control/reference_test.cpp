#include "daemon/control/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "daemon/control/reference_kinds.h"

namespace monitor::control {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of a few operations on numbers near 1.
constexpr double kRounding = 1e-12;

ReferenceConfig of_kind(const char* kind) {
  ReferenceConfig config;
  config.kind = kind;
  return config;
}

TEST(Reference, IsTheSourcesSineByDefault) {
  const auto reference = make_reference(ReferenceConfig{});
  for (const double t_s : {0.0, 0.25, 0.5, 1.0, 1.5, 7.3}) {
    EXPECT_NEAR(reference->at(t_s), 0.0254 * std::sin(2.0 * kPi * 0.5 * t_s) + 0.305, kRounding);
  }
}

TEST(Reference, TriangleGoesToAndFroAtConstantSpeed) {
  ReferenceConfig config = of_kind("triangle");
  config.centre_m = 0.3;
  config.amplitude_m = 0.02;
  config.frequency_Hz = 0.5;
  const auto reference = make_reference(config);
  const double expected_m[] = {0.3, 0.31, 0.32, 0.31, 0.3, 0.29, 0.28, 0.29, 0.3};
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(reference->at(0.25 * i), expected_m[i], kRounding) << i;
    EXPECT_NEAR(reference->at(100.0 + 0.25 * i), expected_m[i], kRounding) << i;
  }
}

TEST(Reference, MultisinePeaksAtTheAmplitudeAndHoldsOnlyItsFrequencies) {
  ReferenceConfig config = of_kind("multisine");
  config.centre_m = 0.0;
  config.amplitude_m = 0.02;
  config.frequencies_Hz = {0.5, 1.0, 2.5};
  const auto reference = make_reference(config);
  constexpr int kPoints = 40000;  // ten whole common periods of 2 s
  constexpr double kStep_s = 20.0 / kPoints;
  double peak = 0.0;
  for (int i = 0; i < kPoints; ++i) peak = std::max(peak, std::abs(reference->at(i * kStep_s)));
  EXPECT_NEAR(peak, 0.02, 0.02 * 1e-3);
  // Fourier sums: equal lines at the listed frequencies, nothing at another.
  const auto line = [&](double f_Hz) {
    double re = 0.0;
    double im = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = 2.0 * kPi * f_Hz * i * kStep_s;
      re += reference->at(i * kStep_s) * std::cos(angle);
      im += reference->at(i * kStep_s) * std::sin(angle);
    }
    return std::hypot(re, im) * 2.0 / kPoints;
  };
  EXPECT_GT(line(0.5), 0.005);
  EXPECT_NEAR(line(1.0), line(0.5), 1e-9);
  EXPECT_NEAR(line(2.5), line(0.5), 1e-9);
  EXPECT_NEAR(line(1.5), 0.0, 1e-9);
}

TEST(Reference, ChirpHasThePhaseOfALinearSweepAndGoesOnWithoutAJump) {
  ReferenceConfig config = of_kind("chirp");
  config.centre_m = 0.1;
  config.amplitude_m = 0.01;
  config.frequency_Hz = 0.2;
  config.frequency_end_Hz = 4.0;
  config.sweep_s = 10.0;
  const auto reference = make_reference(config);
  for (const double t_s : {0.0, 0.7, 3.3, 9.9}) {
    // phase = 2 pi integral of the frequency 0.2 + 0.38 t
    const double phase = 2.0 * kPi * (0.2 * t_s + 0.38 * t_s * t_s / 2.0);
    EXPECT_NEAR(reference->at(t_s), 0.1 + 0.01 * std::sin(phase), kRounding);
  }
  // Greatest speed is amplitude times 2 pi 4 Hz: no jump between neighbours, also where it wraps.
  for (int i = 0; i < 40000; ++i) {
    const double step_m = reference->at((i + 1) * 1e-3) - reference->at(i * 1e-3);
    ASSERT_LE(std::abs(step_m), 0.01 * 2.0 * kPi * 4.0 * 1e-3 * 1.0001) << "at " << i << " ms";
  }
}

TEST(Reference, StepsHoldTheirLevelsAndJoinThemSmoothly) {
  ReferenceConfig config = of_kind("steps");
  config.hold_s = 1.0;
  config.rise_s = 0.2;
  config.seed = 7;
  const Steps steps(config);
  for (int k = 0; k < 200; ++k) {
    const double level_m = steps.level_m(k);
    EXPECT_LE(std::abs(level_m - config.centre_m), config.amplitude_m);
    EXPECT_DOUBLE_EQ(steps.at(k + 0.2), level_m);
    EXPECT_DOUBLE_EQ(steps.at(k + 0.9), level_m);
    // The quintic passes the middle at half its time, with slope 15/8 of the mean one.
    const double before_m = steps.level_m(k - 1);
    EXPECT_NEAR(steps.at(k + 0.1), 0.5 * (before_m + level_m), kRounding);
    const double slope_mps = (steps.at(k + 0.1001) - steps.at(k + 0.0999)) / 2e-4;
    EXPECT_NEAR(slope_mps, 1.875 * (level_m - before_m) / 0.2, 1e-5);
  }
}

TEST(Reference, StepLevelsAreSpreadEvenlyAndDependOnTheSeed) {
  ReferenceConfig config = of_kind("steps");
  config.centre_m = 0.0;
  config.amplitude_m = 1.0;
  const Steps one(config);
  config.seed = 2;
  const Steps two(config);
  double sum = 0.0;
  double sum_square = 0.0;
  int equal = 0;
  constexpr int kLevels = 3000;
  for (int k = 0; k < kLevels; ++k) {
    sum += one.level_m(k);
    sum_square += one.level_m(k) * one.level_m(k);
    if (one.level_m(k) == two.level_m(k)) ++equal;
  }
  // Uniform in [-1, 1]: mean 0 with standard error 0.0105, mean square 1/3 with 0.0054.
  EXPECT_NEAR(sum / kLevels, 0.0, 4 * 0.0105);
  EXPECT_NEAR(sum_square / kLevels, 1.0 / 3.0, 4 * 0.0054);
  EXPECT_EQ(equal, 0);
}

/// Fibonacci register written out: x^9 + x^5 + 1 says b[i] = b[i-9] xor b[i-5], whatever the start.
TEST(Reference, PrbsObeysItsPolynomialsRecurrence) {
  ReferenceConfig config = of_kind("prbs");
  config.register_bits = 9;
  config.hold_s = 0.1;
  config.centre_m = 0.0;
  config.amplitude_m = 1.0;
  const Prbs prbs(config);
  const auto bit = [&](int i) { return prbs.at((i + 0.5) * 0.1) > 0.0; };
  for (int i = 9; i < 1100; ++i) {
    ASSERT_EQ(bit(i), bit(i - 9) != bit(i - 5)) << "bit " << i;
  }
}

TEST(Reference, PrbsOfEveryLengthIsMaximal) {
  for (int n = 3; n <= 16; ++n) {
    ReferenceConfig config = of_kind("prbs");
    config.register_bits = n;
    config.hold_s = 1.0;
    config.centre_m = 0.0;
    config.amplitude_m = 1.0;
    const Prbs prbs(config);
    const int period = (1 << n) - 1;
    // Maximal length: every n-bit word but zero comes up exactly once in a period.
    std::vector<int> seen(static_cast<std::size_t>(period) + 1, 0);
    int word = 0;
    for (int i = 0; i < period + n - 1; ++i) {
      word = ((word << 1) | (prbs.at(i + 0.5) > 0.0 ? 1 : 0)) & period;
      if (i >= n - 1) ++seen[static_cast<std::size_t>(word)];
    }
    EXPECT_EQ(seen[0], 0) << n << " bits";
    EXPECT_EQ(std::count(seen.begin() + 1, seen.end(), 1), period) << n << " bits";
  }
}

TEST(Reference, FileIsJoinedByStraightLinesAndHeldOutside) {
  const auto file = std::filesystem::temp_directory_path() / "spoolwatch_reference_test.csv";
  std::ofstream(file) << "t_s,reference_m\n1.0,0.2\n2,0.4\r\n4,0.3\n";
  ReferenceConfig config = of_kind("file");
  config.file = file.string();
  const auto reference = make_reference(config);
  EXPECT_DOUBLE_EQ(reference->at(0.0), 0.2);
  EXPECT_DOUBLE_EQ(reference->at(1.25), 0.25);
  EXPECT_DOUBLE_EQ(reference->at(3.0), 0.35);
  EXPECT_DOUBLE_EQ(reference->at(9.0), 0.3);
  for (const char* bad : {"", "t_s,y_m\n1,1\n", "t_s,reference_m\n", "t_s,reference_m\n1,x\n",
                          "t_s,reference_m\n1,nan\n", "t_s,reference_m\n2,1\n1,1\n"}) {
    std::ofstream(file) << bad;
    EXPECT_THROW((void)make_reference(config), config::schema::Error) << bad;
  }
  std::filesystem::remove(file);
}

TEST(Reference, RefusesAMultisineWithoutSines) {
  ReferenceConfig no_sines = of_kind("multisine");
  no_sines.frequencies_Hz.clear();
  EXPECT_THROW((void)make_reference(no_sines), config::schema::Error);
}

TEST(Reference, RefusesKeysOfAnotherKind) {
  ReferenceConfig config;
  const auto text = "schema_version = 1\nkind = \"sine\"\nsweep_s = 3.0\n";
  EXPECT_THROW(config::schema::Document::parse(text, "test").read([&](config::schema::Visitor& v) {
    config.visit(v);
  }),
               config::schema::Error);
}

}  // namespace
}  // namespace monitor::control
