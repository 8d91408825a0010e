#include "estimator/greybox/disturbance/spectral_lines.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "estimator/greybox/disturbance/kalman_gains.h"
#include "estimator/greybox/disturbance/simulated_lines.h"
#include "estimator/greybox/observer_simulation.h"
#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;

constexpr double kFrequency_Hz = 11.3;

struct AxisFilter {
  Dataset record = axis_record(1600);
  Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  InnovationGains gains =
      kalman_gains(model, record,
                   {.disturbance_sd = 1.0, .corner_Hz = 2.0, .walk_m = 1e-8, .sensor_m = 1e-6},
                   1e-6)
          .gains;
};

Eigen::VectorXd innovations(const Dataset& record, const InnovationGains& gains,
                            const Eigen::MatrixXd& added_N = {}) {
  Dataset with = record;
  with.innovations = std::make_shared<const InnovationGains>(gains);
  ObserverSimulation run(axis(), with, {});
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::MatrixXd(0, 1), {}, added_N, residuals_m);
  return residuals_m.col(0);
}

// The nonlinear simulation with the force added to the model against the linear response: a force
// that the model knows of lowers the innovations by what one that it does not know of causes.
TEST(SpectralLines, AForcesResponseIsThatOfTheSimulation) {
  const AxisFilter s;
  Eigen::MatrixXd force_N(1600, 1);
  for (Eigen::Index k = 0; k < 1600; ++k) {
    force_N(k, 0) = 2.0 * std::sin(2.0 * std::numbers::pi * kFrequency_Hz *
                                   s.record.t_s[static_cast<std::size_t>(k)]);
  }
  const Eigen::VectorXd change =
      innovations(s.record, s.gains) - innovations(s.record, s.gains, force_N);
  const Eigen::MatrixXd response =
      line_response(s.model, s.record, s.gains, {LineSite::force, kFrequency_Hz});
  EXPECT_LT((change - 2.0 * response.col(0)).norm(), 1e-3 * change.norm());
}

TEST(SpectralLines, AShakingSensorIsFoundWithFrequencyAndAmplitude) {
  AxisFilter s;
  for (std::size_t k = 0; k < s.record.size(); ++k) {
    s.record.y_m[k] +=
        3e-6 * std::cos(2.0 * std::numbers::pi * kFrequency_Hz * s.record.t_s[k] + 0.4);
  }
  Dataset still = axis_record(1600);
  const Eigen::VectorXd seen = innovations(s.record, s.gains) - innovations(still, s.gains);
  const std::vector<SpectralLine> lines = promising_lines(s.model, s.record, s.gains, seen);
  ASSERT_FALSE(lines.empty());
  const bool found = std::any_of(lines.begin(), lines.end(), [](const SpectralLine& line) {
    return line.site == LineSite::sensor && std::abs(line.frequency_Hz - kFrequency_Hz) < 0.07;
  });
  EXPECT_TRUE(found);
  const SpectralLine line{LineSite::sensor, kFrequency_Hz};
  const Eigen::Vector2d wave = fit_waves(s.model, s.record, s.gains, {line}, seen).front();
  EXPECT_NEAR(wave.norm(), 3e-6, 0.02 * 3e-6);
  EXPECT_NEAR(line_amplitude(s.model, s.record, line, wave).rms_m, 3e-6 / std::sqrt(2.0),
              0.05 * 3e-6);
}

TEST(SpectralLines, TheSensitivityToAFrequencyIsThatOfADifferenceQuotient) {
  const AxisFilter s;
  const Eigen::Vector2d wave(2.0, -1.5);
  constexpr double kStep_Hz = 1e-5;
  constexpr double kMiddle_s = 4.0;
  const auto response = [&](double by_Hz) -> Eigen::VectorXd {
    return line_response(s.model, s.record, s.gains, {LineSite::force, kFrequency_Hz + by_Hz}) *
           with_frequency_moved(wave, by_Hz, kMiddle_s);
  };
  const Eigen::VectorXd quotient = (response(kStep_Hz) - response(-kStep_Hz)) / (2.0 * kStep_Hz);
  const Eigen::VectorXd slope = frequency_sensitivity(
      s.model, s.record, s.gains, {LineSite::force, kFrequency_Hz}, wave, kMiddle_s);
  EXPECT_LT((quotient - slope).norm(), 1e-4 * slope.norm());
}

TEST(SpectralLines, AMovedFrequencyKeepsTheValueAtItsMoment) {
  const Eigen::Vector2d wave(2.0, -1.5);
  constexpr double kAt_s = 3.7;
  const auto value = [&](double frequency_Hz, const Eigen::Vector2d& of) {
    const double angle = 2.0 * std::numbers::pi * frequency_Hz * kAt_s;
    return of.dot(Eigen::Vector2d(std::sin(angle), std::cos(angle)));
  };
  EXPECT_NEAR(value(11.4, with_frequency_moved(wave, 0.1, kAt_s)), value(11.3, wave), 1e-12);
}

// The predictor of a record whose line is known sees the record without it.
TEST(SpectralLines, AKnownLineLeavesTheInnovationsOfAStillSensor) {
  AxisFilter s;
  for (std::size_t k = 0; k < s.record.size(); ++k) {
    const double angle = 2.0 * std::numbers::pi * kFrequency_Hz * s.record.t_s[k];
    s.record.y_m[k] += 3e-5 * std::sin(angle) + 4e-5 * std::cos(angle);
  }
  const Dataset still = axis_record(1600);
  const Eigen::VectorXd before = innovations(still, s.gains);
  EXPECT_GT((innovations(s.record, s.gains) - before).norm(), 1e-5);
  s.gains.line_m =
      simulated_lines_m(axis(), s.record, {}, Eigen::VectorXd(),
                        {{LineSite::sensor, kFrequency_Hz}}, {Eigen::Vector2d(3e-5, 4e-5)});
  EXPECT_LT((innovations(s.record, s.gains) - before).norm(), 1e-9);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
