#include "estimator/greybox/validation/comparison.h"
#include "config/record/record.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/workbench/compare/servo_record.h"
#include "workbench/compare/comparison_report.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

using compare_test::healthy;
using compare_test::kGain;
using compare_test::kTs;
using compare_test::servo;
using compare_test::servo_record;

constexpr double kBias_V = 0.04;
constexpr double kObserver = 2.0;
/// Rounding of positions of 0.3 m, summed over thousands of steps.
constexpr double kRounding_m = 1e-11;

validation::Comparison compared(const compare_test::Fault& fault, double noise_m = 0.0) {
  return validation::compare(servo(), greybox::dataset_of(servo_record(fault, 30.0, noise_m)));
}

double bias(double, double, double) { return kGain * kBias_V; }

// e(k+1) = (1 - l Ts) e(k) + g b Ts, so e(k) = g b / l + (e(j) - g b / l) (1 - l Ts)^(k - j); the
// free run g b k Ts. The record begins in motion: l is kLeading_per_s for its first 100 samples.
TEST(Comparison, HasTheClosedFormErrorOfAServoWithABias) {
  const validation::Comparison c = compared(bias);
  const std::size_t n = c.record.size();
  double squares = 0.0;
  double free_squares = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto steps = static_cast<double>(k);
    const auto from = [&](double e0_m, double rate_per_s, double after) {
      const double last_m = kGain * kBias_V / rate_per_s;
      return last_m + (e0_m - last_m) * std::pow(1.0 - rate_per_s * kTs, after);
    };
    const double e_m =
        k <= 100 ? from(0.0, greybox::kInitialisation_per_s, steps)
                 : from(from(0.0, greybox::kInitialisation_per_s, 100.0), kObserver, steps - 100.0);
    const double free_m = kGain * kBias_V * kTs * steps;
    ASSERT_NEAR(c.error_m[k], e_m, kRounding_m) << k;
    ASSERT_NEAR(c.free_error_m[k], free_m, kRounding_m) << k;
    squares += k < 100 ? 0.0 : e_m * e_m;
    free_squares += free_m * free_m;
  }
  EXPECT_NEAR(c.rms_m, std::sqrt(squares / static_cast<double>(n - 100)), kRounding_m);
  EXPECT_NEAR(c.free_run_rms_m, std::sqrt(free_squares / static_cast<double>(n)), kRounding_m);
}

TEST(Comparison, PredictsKStepsAheadWithKTimesTheErrorOfOne) {
  const validation::Comparison c = compared(bias);
  ASSERT_EQ(c.k_step.size(), 3U);
  for (const validation::KStep& k : c.k_step) {
    EXPECT_NEAR(k.rms_m, kGain * kBias_V * kTs * static_cast<double>(k.samples), kRounding_m);
  }
  EXPECT_EQ(c.k_step[0].count, 5899U);  // 6000 samples, 100 of them unsettled, one has no next
  EXPECT_GT(c.k_step[2].count, 200U);   // four runs set off against each other
}

TEST(Comparison, GivesTheFitOfTheFreeRunInPercent) {
  const validation::Comparison c = compared(bias);
  double mean_m = 0.0;
  for (const double y_m : c.record.y_m) mean_m += y_m / static_cast<double>(c.record.size());
  double error = 0.0;
  double motion = 0.0;
  for (std::size_t k = 0; k < c.record.size(); ++k) {
    error += std::pow(kGain * kBias_V * kTs * static_cast<double>(k), 2);
    motion += std::pow(c.record.y_m[k] - mean_m, 2);
  }
  EXPECT_NEAR(c.fit_percent, 100.0 * (1.0 - std::sqrt(error / motion)), 1e-6);
}

TEST(Comparison, ExplainsABiasByAConstantSpeedAndAGainInProportion) {
  const validation::Comparison offset = compared(bias);
  EXPECT_EQ(offset.systematic.cause, validation::ErrorCause::offset);
  EXPECT_NEAR(offset.systematic.offset_mps, kGain * kBias_V, 1e-8);
  EXPECT_GT(offset.systematic.share, 0.999);
  const validation::Comparison gain =
      compared([](double, double u, double) { return 0.03 * kGain * u; });
  EXPECT_EQ(gain.systematic.cause, validation::ErrorCause::gain);
  // Led back to the measurement, the model's own speed is a little more than g u.
  EXPECT_NEAR(gain.systematic.gain_ratio, 0.03, 0.002);
  EXPECT_GT(gain.systematic.share, 0.99);
}

TEST(Comparison, FindsTheNoiseFloorAndNothingElseInAHealthyRecord) {
  const validation::Comparison c = compared(healthy, 2e-6);
  const double floor_m = std::sqrt(4.0 + 25.0 / 12.0) * 1e-6;
  EXPECT_NEAR(c.noise_floor_m, floor_m, 0.1 * floor_m);
  EXPECT_NEAR(c.encoder_step_m, 5e-6, 1e-9);
  EXPECT_NEAR(c.rms_m, floor_m, 0.1 * floor_m);
  EXPECT_NEAR(c.k_step[0].rms_m, std::sqrt(2.0) * floor_m, 0.1 * floor_m);
  EXPECT_GT(c.whiteness_p, 1e-3);
  EXPECT_GT(c.independence_p, 1e-3);
  EXPECT_FALSE(c.headline.significant);
  for (const validation::SignificantRegion& failing : c.worst) EXPECT_FALSE(failing.significant);
}

/// A fault somewhere, and the variable and range that must come out first.
struct Somewhere {
  const char* name;
  compare_test::Fault fault;
  const char* variable;
  double from;
  double to;
  double tolerance;
  double share;  ///< least share of the speed error
};

class FailingIn : public testing::TestWithParam<Somewhere> {};

INSTANTIATE_TEST_SUITE_P(
    Regions, FailingIn,
    testing::Values(Somewhere{"slow",
                              [](double, double u, double) {
                                return std::abs(kGain * u) < 0.01 ? -0.4 * kGain * u : 0.0;
                              },
                              "speed", 0.0, 0.01, 0.0101, 0.6},
                    Somewhere{"fast",
                              [](double, double u, double) {
                                return std::abs(u) > 0.8 ? -0.1 * kGain * u : 0.0;
                              },
                              "speed", 0.04, 0.07, 0.011, 0.15},
                    Somewhere{"time",
                              [](double t_s, double u, double) {
                                return t_s > 15.0 && t_s < 20.0 ? -0.2 * kGain * u : 0.0;
                              },
                              "time", 15.0, 20.0, 1e-9, 0.6},
                    Somewhere{"place",
                              [](double, double u, double y) {
                                return y > 0.33 ? -0.3 * kGain * u : 0.0;
                              },
                              "y", 0.33, 0.335, 0.011, 0.6}),
    [](const auto& each) { return std::string(each.param.name); });

TEST_P(FailingIn, ComesOutFirst) {
  const validation::Comparison c = compared(GetParam().fault, 2e-6);
  ASSERT_FALSE(c.worst.empty());
  const validation::SignificantRegion& first = c.worst.front();
  EXPECT_TRUE(first.significant);
  EXPECT_EQ(first.ranges.front().variable, GetParam().variable);
  EXPECT_NEAR(first.figures.from, GetParam().from, GetParam().tolerance);
  EXPECT_NEAR(first.figures.to, GetParam().to, GetParam().tolerance);
  EXPECT_GT(first.figures.local_velocity_error_share, GetParam().share);
}

TEST(Regions, ShareTimeAndErrorOutCompletely) {
  const validation::Comparison c = compared(bias, 2e-6);
  ASSERT_EQ(c.regions.size(), 7U);
  double squares = 0.0;
  for (std::size_t k = 0; k < c.record.size(); ++k) {
    if (c.record.valid[k] != 0) squares += c.error_m[k] * c.error_m[k];
  }
  for (const validation::Region& region : c.regions) {
    std::size_t count = 0;
    double time = 0.0;
    double error = 0.0;
    double sum = 0.0;
    for (const validation::Bin& bin : region.bins) {
      count += bin.count;
      time += bin.time_share;
      error += bin.error_share;
      sum += static_cast<double>(bin.count) * bin.rms_m * bin.rms_m;
    }
    EXPECT_EQ(count, 5900U) << region.variable;
    EXPECT_NEAR(time, 1.0, 1e-9) << region.variable;
    EXPECT_NEAR(error, 1.0, 1e-9) << region.variable;
    EXPECT_NEAR(sum, squares, 1e-9 * squares) << region.variable;
  }
}

TEST(Regions, GiveTheSpeedErrorOfEachDirection) {
  const validation::Comparison c =
      compared([](double, double u, double) { return u > 0.0 ? -0.1 * kGain * u : 0.0; });
  for (const validation::Region& region : c.regions) {
    if (region.variable != "direction") continue;
    for (const validation::Bin& bin : region.bins) {
      if (bin.name == "extending") {
        EXPECT_LT(bin.speed_error_mps, -1e-3);
      }
      if (bin.name == "retracting") {
        EXPECT_NEAR(bin.speed_error_mps, 0.0, 1e-4);
      }
    }
  }
}

TEST(Comparison, StartsAnewBehindAGap) {
  config::record::Record record = servo_record(bias);
  for (auto* column : {&record.t_s, &record.u_V, &record.y_m}) {
    column->erase(column->begin() + 3000, column->begin() + 3100);
  }
  record.gaps = {3000};
  const validation::Comparison c = validation::compare(servo(), greybox::dataset_of(record));
  EXPECT_EQ(c.record.starts.size(), 2U);
  EXPECT_NEAR(c.free_error_m[2999], kGain * kBias_V * kTs * 2999.0, kRounding_m);
  EXPECT_NEAR(c.free_error_m[3000], 0.0, kRounding_m);
  // led for half a second, which leaves g b / l, and free from there
  const double led_m = kGain * kBias_V / greybox::kInitialisation_per_s;
  EXPECT_NEAR(c.free_error_m[3200], led_m + kGain * kBias_V * kTs * 100.0, 1e-4 * led_m);
  EXPECT_NEAR(c.k_step[0].rms_m, kGain * kBias_V * kTs, kRounding_m);
}

TEST(Comparison, SaysTheSameAtOtherRates) {
  for (const double sample_time_s : {0.001, 0.02}) {
    const validation::Comparison c = validation::compare(
        servo(), greybox::dataset_of(servo_record(bias, 20.0, 2e-6, sample_time_s)));
    EXPECT_NEAR(c.systematic.offset_mps, kGain * kBias_V, 1e-5) << sample_time_s;
    EXPECT_NEAR(c.rms_m, kGain * kBias_V / kObserver, 0.05 * c.rms_m) << sample_time_s;
  }
}

TEST(Sections, HavePlotsWhoseSeriesAreAsLongAsTheirAxis) {
  config::record::Record record = servo_record(bias, 20.0, 2e-6);
  record.gaps = {2000};
  const validation::Comparison c = validation::compare(servo(), greybox::dataset_of(record));
  const std::vector<present::Section> all = sections(c, "first ");
  std::size_t plots = 0;
  for (const present::Section& section : all) {
    for (const present::Plot& plot : section.plots) {
      ++plots;
      const std::size_t length =
          plot.categories.empty() ? plot.x_values.size() : plot.categories.size();
      for (const present::Series& series : plot.series) {
        EXPECT_EQ(series.y.size(), series.x.empty() ? length : series.x.size());
      }
      if (!plot.zoom_group.empty()) {
        EXPECT_EQ(plot.zoom_group, "first time");
      }
    }
  }
  EXPECT_EQ(plots, 17U);
  EXPECT_THAT(present::render(make_report(c, "spoolwatch compare a b")),
              testing::HasSubstr("spoolwatch compare a b"));
}

}  // namespace
}  // namespace workbench::compare
