// Plots by frequency, of series whose spectra are written down.
#include "workbench/present/dynamics_plots.h"
#include "tests/estimator/spectra/white_noise.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace workbench::present {
namespace {

using spectra_test::white_noise;

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kSampleTime_s = 0.005;
constexpr double kGain_mps_per_V = 0.05;

/// An integrator: its speed is the gain times the command at every frequency.
estimator::greybox::Dataset integrator(const std::vector<double>& u_V) {
  std::vector<double> y_m{0.3};
  for (std::size_t k = 0; k + 1 < u_V.size(); ++k) {
    y_m.push_back(y_m.back() + kSampleTime_s * kGain_mps_per_V * u_V[k]);
  }
  return estimator::greybox::dataset_of(kSampleTime_s, u_V, y_m);
}

TEST(DynamicsPlots, AResponseIsLevelForAnIntegratorAndLiesInItsBand) {
  const auto record = integrator(white_noise(6000, 1.0, 1));
  const std::vector<Plot> plots =
      response_plots(record, {{"model", Tone::model, record.y_m}}, 1e-6);
  ASSERT_THAT(plots, SizeIs(2));
  const Series& measured = plots[0].series[0];
  ASSERT_THAT(measured.low, SizeIs(measured.y.size()));
  for (std::size_t i = 0; i < measured.y.size(); ++i) {
    EXPECT_NEAR(measured.y[i], 50.0, 0.01);  // mm/s per V
    EXPECT_LE(measured.low[i], measured.y[i]);
    EXPECT_GE(measured.high[i], measured.y[i]);
    EXPECT_NEAR(plots[1].series[0].y[i], 0.0, 0.1);  // degrees
  }
  EXPECT_EQ(plots[0].series[1].y, measured.y);  // the same position
}

TEST(DynamicsPlots, AMotionOfOneFrequencyHasNoResponseElsewhere) {
  std::vector<double> u_V;
  for (int k = 0; k < 6000; ++k) u_V.push_back(std::sin(2.0 * std::numbers::pi * 0.01 * k));
  auto record = integrator(u_V);
  const std::vector<double> sensor_m = white_noise(6000, 1e-5, 2);
  for (std::size_t k = 0; k < record.size(); ++k) record.y_m[k] += sensor_m[k];
  // the main lobe of the windows, which are 5.12 s long, and some steps of it
  for (const Plot& plot : response_plots(record, {}, 1e-5)) {
    for (const double f_Hz : plot.series[0].x) EXPECT_NEAR(f_Hz, 2.0, 1.0);
  }
  record.u_V = white_noise(6000, 1.0, 5);  // and nothing is known of a command that does not act
  EXPECT_THAT(response_plots(record, {}, 1e-5), IsEmpty());
}

TEST(DynamicsPlots, WhiteResidualsLieAtTheNoiseFloorAndWithinTheirBound) {
  constexpr double kNoise_m = 2e-6;
  const auto record = integrator(white_noise(20000, 1.0, 3));
  const std::vector<NamedValues> residual{
      {"residual", Tone::residual, white_noise(20000, kNoise_m, 4)}};
  const Plot spectrum = spectrum_plot(record, residual, kNoise_m);
  ASSERT_THAT(spectrum.lines, SizeIs(1));
  double mean_square = 0.0;
  for (const double y : spectrum.series[0].y) {
    mean_square += y * y / static_cast<double>(spectrum.series[0].y.size());
  }
  EXPECT_NEAR(std::sqrt(mean_square), spectrum.lines[0].value, 0.1 * spectrum.lines[0].value);
  const Plot correlation = autocorrelation_plot(record, residual);
  EXPECT_NEAR(correlation.lines[0].value, 1.96 / std::sqrt(20000.0), 1e-6);
  EXPECT_EQ(correlation.x_values.back(), 1.0);
}

TEST(DynamicsPlots, AResonanceIsSaidWithItsErrors) {
  EXPECT_EQ(resonance_words({34.02, 0.11, 0.0312, 0.0021, 5.0}).substr(0, 45),
            "34.02 +- 0.11 Hz, damping 3.12 +- 0.21 %: the");
}

}  // namespace
}  // namespace workbench::present
