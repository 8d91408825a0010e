#include "estimator/greybox/disturbance/kalman_gains.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "estimator/greybox/disturbance/predictor.h"
#include "estimator/greybox/disturbance/riccati_lanes.h"
#include "estimator/greybox/observer_simulation.h"
#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;

/// y(k+1) = y(k) + walk: the smallest filter there is.
Linearisation random_walk(std::size_t samples) {
  Linearisation model;
  model.states = {"y_m"};
  StateMatrix keep = StateMatrix::Zero();
  keep(0, 0) = 1.0;
  model.transition.assign(samples, keep);
  model.from_supply.assign(samples, StateVector::Zero());
  model.speed_mps.assign(samples, 0.0);
  return model;
}

// P = P R/(P + R) + Q has the root P = (Q + sqrt(Q^2 + 4 Q R)) / 2.
TEST(KalmanGains, OfARandomWalkSettleAtTheRootOfRiccatisEquation) {
  const Dataset record = axis_record(4000);
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 2e-7, .sensor_m = 3e-6};
  const KalmanGains found = kalman_gains(random_walk(4000), record, noise, 2e-6);
  const double q = noise.walk_m * noise.walk_m;
  const double r = noise.sensor_m * noise.sensor_m;
  const double p = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  EXPECT_NEAR(found.gains.gain(0, 3999), p / (p + r), 1e-9);
  EXPECT_NEAR(found.gains.scale[3999], 2e-6 / std::sqrt(p + r), 1e-9);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < 4000; ++k) sum -= 2.0 * std::log(found.gains.scale[k]);
  EXPECT_NEAR(found.log_determinant, sum, 1e-6);
}

/// Moments of max(x - gap, 0) for x ~ N(0, sd), by summation; `slope`: the share of x passed on.
struct Passed {
  double slope = 0.0;
  double variance_m2 = 0.0;
};
Passed through_play(double gap_m, double sd_m) {
  double mean_m = 0.0;
  double square_m2 = 0.0;
  double product_m2 = 0.0;
  constexpr double kStep = 1e-4;
  for (double z = -10.0; z < 10.0; z += kStep) {
    const double weight = kStep * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    const double out_m = std::max(sd_m * z - gap_m, 0.0);
    mean_m += weight * out_m;
    square_m2 += weight * out_m * out_m;
    product_m2 += weight * out_m * sd_m * z;
  }
  return {product_m2 / (sd_m * sd_m), square_m2 - mean_m * mean_m};
}

// The first sample's covariance is the sensor's.
TEST(KalmanGains, AReadingBehindAPlayShowsWhatThePlayPassesOn) {
  const Dataset record = axis_record(10);
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 2e-7, .sensor_m = 3e-6};
  const double sd_m = noise.sensor_m;
  for (const double gap_m : {-9e-6, -2e-6, 0.0, 1e-6, 5e-6}) {
    Linearisation model = random_walk(10);
    model.gap_m.assign(10, gap_m);
    const KalmanGains found = kalman_gains(model, record, noise, 2e-6);
    const Passed passed = through_play(gap_m, sd_m);
    const double s_m2 = passed.variance_m2 + sd_m * sd_m;
    EXPECT_NEAR(found.gains.gain(0, 0), passed.slope * sd_m * sd_m / s_m2, 1e-6) << gap_m;
    EXPECT_NEAR(found.gains.scale[0], 2e-6 / std::sqrt(s_m2), 1e-6) << gap_m;
  }
}

TEST(KalmanGains, AWideGapShowsNothingAndFirmContactEverything) {
  const Dataset record = axis_record(400);
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 2e-7, .sensor_m = 3e-6};
  Linearisation model = random_walk(400);
  const KalmanGains open = kalman_gains(model, record, noise, 3e-6);
  model.gap_m.assign(400, -1e-3);
  const KalmanGains firm = kalman_gains(model, record, noise, 3e-6);
  EXPECT_EQ((firm.gains.gain - open.gains.gain).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(firm.log_determinant, open.log_determinant);
  model.gap_m.assign(400, 1e-3);
  const KalmanGains apart = kalman_gains(model, record, noise, 3e-6);
  EXPECT_EQ(apart.gains.gain.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_NEAR(apart.gains.scale[399], 1.0, 1e-9);
}

TEST(KalmanGains, WithoutAnyProcessNoiseTheModelIsTrusted) {
  const Dataset record = axis_record();
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 0.0, .sensor_m = 3e-6};
  const KalmanGains found = kalman_gains(model, record, noise, 3e-6);
  EXPECT_LT(found.gains.gain.col(799).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_NEAR(found.gains.scale[799], 1.0, 0.01);
}

/// The textbook's recursion with Joseph's form of the correction.
KalmanGains by_joseph(const Linearisation& model, const Dataset& record,
                      const NoiseParameters& noise, double floor_m, const StateMatrix& start) {
  const auto count = static_cast<Eigen::Index>(model.states.size());
  const auto samples = static_cast<Eigen::Index>(record.size());
  KalmanGains result;
  result.gains.gain.resize(count + 1, samples);
  result.gains.scale.resize(samples);
  const double decay = std::exp(-2.0 * std::numbers::pi * noise.corner_Hz * record.sample_time_s);
  StateMatrix q = StateMatrix::Zero();
  q(0, 0) = noise.walk_m * noise.walk_m;
  q(kDisturbance, kDisturbance) =
      (1.0 - decay * decay) * noise.disturbance_sd * noise.disturbance_sd;
  const double r = noise.sensor_m * noise.sensor_m;
  StateMatrix p = start;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (std::find(record.starts.begin(), record.starts.end(), row) != record.starts.end()) {
      p = start;
    }
    const double s = p(0, 0) + r;
    const StateVector gain = p.col(0) / s;
    result.gains.gain.col(k) << gain.head(count), gain[kDisturbance];
    result.gains.scale[k] = floor_m / std::sqrt(s);
    if (record.valid[row] != 0) result.log_determinant += std::log(s / (floor_m * floor_m));
    StateMatrix rest = StateMatrix::Identity();
    rest.col(0) -= gain;
    StateMatrix a = model.transition[row];
    a(kDisturbance, kDisturbance) = decay;
    p = (a * (rest * p * rest.transpose() + r * gain * gain.transpose()) * a.transpose() + q)
            .eval();
  }
  return result;
}

// More noise models than are filtered side by side, on a record of two segments with gaps.
// Tolerances: five hundred turns of rounding, which the smallest gains feel most.
TEST(KalmanGains, SeveralNoiseModelsHaveEachTheGainsOfTheTextbooksRecursion) {
  Dataset record = axis_record(500);
  record.starts = {0, 203};
  for (std::size_t k = 77; k < 91; ++k) record.valid[k] = 0;
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  std::vector<NoiseParameters> noise;
  for (int i = 0; i < 11; ++i) {
    const double factor = std::pow(2.0, i - 5);
    noise.push_back({.disturbance_sd = 3.0 * factor,
                     .corner_Hz = 2.0 / factor,
                     .walk_m = 1e-7 * factor,
                     .sensor_m = 3e-6 / factor});
  }
  const std::vector<KalmanGains> found = kalman_gains(model, record, noise, 3e-6);
  ASSERT_EQ(found.size(), noise.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    StateMatrix start = StateMatrix::Zero();
    start(0, 0) = std::pow(noise[i].sensor_m, 2);
    start(kDisturbance, kDisturbance) = std::pow(noise[i].disturbance_sd, 2);
    const KalmanGains truth = by_joseph(model, record, noise[i], 3e-6, start);
    EXPECT_LT((found[i].gains.gain - truth.gains.gain).norm(), 1e-7 * truth.gains.gain.norm());
    EXPECT_LT((found[i].gains.scale - truth.gains.scale).norm(), 1e-9 * truth.gains.scale.norm());
    EXPECT_NEAR(found[i].log_determinant, truth.log_determinant, 1e-6);
    // alone as in company, bit for bit
    const KalmanGains alone = kalman_gains(model, record, noise[i], 3e-6);
    EXPECT_EQ(alone.gains.gain, found[i].gains.gain);
    EXPECT_EQ(alone.gains.scale, found[i].gains.scale);
    EXPECT_EQ(alone.log_determinant, found[i].log_determinant);
  }
}

// Four states and F; the reading is the first, wherever between the two masses the sensor is.
TEST(KalmanGains, OfAnAxisWithASecondMassAreThoseOfTheTextbooksRecursionToo) {
  plant_sim::ModelFile two = axis();
  *two.value("second_mass.mass_ratio") = 0.4;
  *two.value("second_mass.resonance_Hz") = 17.0;
  *two.value("second_mass.damping_ratio") = 0.03;
  *two.value("second_mass.sensor_ratio") = 0.5;
  for (auto& effect : two.effects) effect.present = effect.name == "second_mass";
  const Dataset record = axis_record(400);
  const Linearisation model = linearise(two, record, {}, Eigen::VectorXd(), 1.0);
  ASSERT_EQ(model.states.size(), 4U);
  const NoiseParameters noise{
      .disturbance_sd = 3.0, .corner_Hz = 2.0, .walk_m = 1e-8, .sensor_m = 1e-6};
  StateMatrix start = StateMatrix::Zero();
  start(0, 0) = 1e-12;
  start(kDisturbance, kDisturbance) = 9.0;
  const KalmanGains found = kalman_gains(model, record, noise, 1e-6);
  const KalmanGains truth = by_joseph(model, record, noise, 1e-6, start);
  EXPECT_GT(truth.gains.gain.row(2).norm(), 0.0);
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_LT((found.gains.gain.row(i) - truth.gains.gain.row(i)).norm(),
              1e-6 * truth.gains.gain.row(i).norm())
        << i;
  }
  EXPECT_NEAR(found.log_determinant, truth.log_determinant, 1e-6);
  EXPECT_EQ(found.gains.force_place, 1.0);
}

TEST(KalmanGains, OfNoNoiseModelAreNone) {
  const Dataset record = axis_record(10);
  EXPECT_TRUE(kalman_gains(random_walk(10), record, std::vector<NoiseParameters>(), 1e-6).empty());
}

TEST(RiccatiLanes, EveryInstructionSetGivesTheSameBits) {
  const Dataset record = axis_record(300);
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  LaneNoise noise;
  for (std::size_t lane = 0; lane < kNoiseLanes; ++lane) {
    const auto i = static_cast<double>(lane + 1);
    noise.decay[lane] = 1.0 - 0.03 * i;
    noise.disturbance_variance[lane] = i;
    noise.walk_m2[lane] = 1e-14 * i;
    noise.sensor_m2[lane] = 9e-12 / i;
  }
  std::array<StateMatrix, kNoiseLanes> start;
  start.fill(1e-10 * StateMatrix::Identity());
  const auto gains_with = [&](plant_sim::InstructionSet set) {
    std::vector<double> values(kNoiseLanes * 300 * 4);
    std::array<LaneResult, kNoiseLanes> results;
    for (std::size_t lane = 0; lane < kNoiseLanes; ++lane) {
      double* const at = values.data() + lane * 1200;
      results[lane] = {at, at + 900};
    }
    riccati({&model, record.valid.data(), 0, 300, 3e-6}, start, noise, results, kNoiseLanes, set);
    for (const LaneResult& result : results) values.push_back(result.log_determinant);
    return values;
  };
  const std::vector<double> baseline = gains_with(plant_sim::InstructionSet::baseline);
  for (const auto set : {plant_sim::InstructionSet::avx2, plant_sim::InstructionSet::avx512}) {
    if (plant_sim::runs_here(set)) {
      EXPECT_EQ(gains_with(set), baseline);
    }
  }
}

// The chambers of an actuator: four states and F. At rest the load pressure begins uncertain by
// 1 bar; pressures of 1e10 Pa^2 beside positions of 1e-12 m^2 cost digits.
TEST(KalmanGains, OfAnActuatorAreThoseOfTheTextbooksRecursionToo) {
  const plant_sim::ModelFile actuator =
      plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml");
  Dataset record = axis_record(400);
  const Linearisation model = linearise(actuator, record, {}, Eigen::VectorXd());
  ASSERT_EQ(model.states.size(), 4U);
  const NoiseParameters noise{
      .disturbance_sd = 25.0, .corner_Hz = 2.0, .walk_m = 1e-7, .sensor_m = 3e-6};
  StateMatrix start = StateMatrix::Zero();
  start(0, 0) = 9e-12;
  start.block<2, 2>(2, 2) << 1e10, -1e10, -1e10, 1e10;
  start(kDisturbance, kDisturbance) = 625.0;
  const KalmanGains found = kalman_gains(model, record, noise, 3e-6);
  const KalmanGains truth = by_joseph(model, record, noise, 3e-6, start);
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_LT((found.gains.gain.row(i) - truth.gains.gain.row(i)).norm(),
              1e-5 * truth.gains.gain.row(i).norm())
        << i;
  }
  EXPECT_NEAR(found.log_determinant, truth.log_determinant, 1e-5);
}

// The variance of the weak observer's error, summed here from the impulse responses instead.
TEST(KalmanGains, TheDisturbedFloorIsThatOfTheWeakObserver) {
  const Dataset record = axis_record(3000);
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  const double l = kObserver_per_s * record.sample_time_s;
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 1e-6, .sensor_m = 1e-6};
  // without a disturbance only y matters: e(k+1) = (1 - l) e(k) + walk + l sensor
  const double variance = (1.0 + l * l) / (1.0 - (1.0 - l) * (1.0 - l)) * 1e-12 + 1e-12;
  EXPECT_NEAR(disturbed_rms_m(model, record, noise), std::sqrt(variance),
              0.03 * std::sqrt(variance));
}

}  // namespace
}  // namespace estimator::greybox::disturbance
