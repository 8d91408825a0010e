// Gains that follow the parameters, against gains computed at each point anew.
#include "estimator/greybox/disturbance/following_gains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "config/schema/document.h"
#include "tests/workbench/diagnose/two_masses.h"

namespace estimator::greybox::disturbance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An axis with a second mass, whose resonance decides the gains.
class FollowingGainsTest : public testing::Test {
 protected:
  FollowingGainsTest() {
    two_masses::Rig rig;
    rig.duration_s = 2.0;
    config::record::Record record = two_masses::record(rig);
    record.name = "two masses";
    record.sample_time_s = 1.0 / rig.sample_rate_Hz;
    data_ = fit_dataset({dataset_of(record)}, {});
    data_.noise_floor_m = rig.noise_m;
    for (const char* name : {"mass_kg", "second_mass.resonance_Hz"}) {
      FreeParameter parameter;
      parameter.name = name;
      parameter.unit = *model_.value(name);
      parameters_.push_back(parameter);
    }
    NoiseParameters noise;
    noise.disturbance_sd = 1.0;
    noise.corner_Hz = 2.0;
    noise.walk_m = 1e-8;
    noise.sensor_m = rig.noise_m;
    unknowns_.resize(2 + kNoiseCoordinates);
    for (nonlinear::Unknown& unknown : unknowns_) unknown.step = kStep;
    for (std::size_t i = 2; i < unknowns_.size(); ++i) unknowns_[i].step = kNoiseStep;
    trial_.resize(2 + kNoiseCoordinates);
    trial_ << 1.0, 1.0, point_of(noise);
  }

  [[nodiscard]] KalmanGains anew(const VectorXd& point) const {
    const Linearisation linear =
        linearise(model_, data_.records.front(), parameters_, point.head(2));
    return kalman_gains(linear, data_.records.front(), noise_of(point.tail<kNoiseCoordinates>()),
                        data_.noise_floor_m);
  }

  [[nodiscard]] FollowingGains following_gains(unsigned threads = 1) const {
    return {model_, data_, parameters_, unknowns_, plant_sim::kPlaceOfSensor, threads};
  }

  /// A trial and points beside it.
  [[nodiscard]] static MatrixXd group(const VectorXd& trial) {
    MatrixXd points = trial.replicate(1, 4);
    points(0, 1) += kStep;
    points(1, 2) += kStep;
    points(3, 3) += kNoiseStep;
    return points;
  }

  static void expect_equal(const KalmanGains& found, const KalmanGains& expected) {
    EXPECT_EQ(found.gains.gain, expected.gains.gain);
    EXPECT_EQ(found.gains.scale, expected.gains.scale);
    EXPECT_EQ(found.log_determinant, expected.log_determinant);
  }

  static constexpr double kStep = 1e-3;
  static constexpr double kNoiseStep = 1e-2;
  plant_sim::ModelFile model_ = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"axis\"\nplant = \"force_driven_axis\"\n[parameters]\n"
      "mass_kg = 30.0\ndamping_N_s_per_m = 120.0\ngain_N_per_V = 40.0\n"
      "[effects.second_mass]\nmass_ratio = 0.3\nresonance_Hz = 34\ndamping_ratio = 0.03\n",
      "axis"));
  FitDataset data_;
  std::vector<FreeParameter> parameters_;
  std::vector<nonlinear::Unknown> unknowns_;
  VectorXd trial_;
};

TEST_F(FollowingGainsTest, AFirstGroupIsExact) {
  FollowingGains following = following_gains(2);
  const MatrixXd points = group(trial_);
  const auto found = following.at(points);
  ASSERT_EQ(found.size(), 1U);
  for (Index i = 0; i < points.cols(); ++i)
    expect_equal(found.front()[static_cast<std::size_t>(i)], anew(points.col(i)));
}

TEST_F(FollowingGainsTest, BesideAnotherTrialGainsFollowAsTheyDid) {
  FollowingGains following = following_gains();
  (void)following.at(group(trial_));
  VectorXd next = trial_;
  next.head(2) *= 1.01;
  const MatrixXd points = group(next);
  const auto found = following.at(points).front();
  expect_equal(found[0], anew(next));
  expect_equal(found[3], anew(points.col(3)));
  for (const std::size_t i : {1U, 2U}) {
    const KalmanGains exact = anew(points.col(static_cast<Index>(i)));
    const MatrixXd slope = found[i].gains.gain - found[0].gains.gain;
    const MatrixXd expected = exact.gains.gain - found[0].gains.gain;
    EXPECT_GT(expected.norm(), 0.0);
    EXPECT_LT((slope - expected).norm(), 0.2 * expected.norm()) << i;
    EXPECT_NEAR(found[i].log_determinant - found[0].log_determinant,
                exact.log_determinant - found[0].log_determinant,
                0.2 * std::abs(exact.log_determinant - found[0].log_determinant))
        << i;
  }
}

TEST_F(FollowingGainsTest, PointsAboutTheLastTrialAreExactAndRenewTheSlopes) {
  FollowingGains following = following_gains();
  (void)following.at(group(trial_));
  VectorXd next = trial_;
  next.head(2) *= 1.3;
  (void)following.at(group(next));
  const MatrixXd about = group(next).rightCols(3);
  const auto found = following.at(about).front();
  for (Index i = 0; i < about.cols(); ++i)
    expect_equal(found[static_cast<std::size_t>(i)], anew(about.col(i)));
  const double renewed = found[1].log_determinant - anew(next).log_determinant;
  VectorXd third = next;
  third.head(2) *= 1.3;
  const auto beside = following.at(group(third)).front();
  EXPECT_NEAR(beside[2].log_determinant - beside[0].log_determinant, renewed,
              1e-6 * std::abs(renewed));
}

TEST_F(FollowingGainsTest, ASlopeIsComputedAgainAfterAFewTrials) {
  FollowingGains following = following_gains();
  VectorXd trial = trial_;
  int exact = 0;
  for (int i = 0; i < 9; ++i) {
    const MatrixXd points = group(trial);
    const KalmanGains found = following.at(points).front()[2];
    if (found.gains.gain == anew(points.col(2)).gains.gain) ++exact;
    trial.head(2) *= 1.02;
  }
  EXPECT_EQ(exact, 3);
}

// Without its resonance the second mass is none, and its states go.
TEST_F(FollowingGainsTest, StatesMayComeAndGo) {
  FollowingGains following = following_gains();
  VectorXd rigid = trial_;
  rigid[1] = 0.0;
  for (const VectorXd& trial : {trial_, rigid, trial_}) {
    const MatrixXd points = group(trial);
    const auto found = following.at(points).front();
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_EQ(found[i].gains.states, anew(points.col(static_cast<Index>(i))).gains.states);
  }
}

}  // namespace
}  // namespace estimator::greybox::disturbance
