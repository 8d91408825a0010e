// Fits of a servo v = gain (u + offset) without lag, whose position is linear in gain and
// gain x offset: estimates, priors and standard errors stand beside linear algebra and counting.
#include "estimator/greybox/fit.h"

#include <gmock/gmock.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>

namespace estimator::greybox {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kTs = 0.005;
constexpr double kGain = 0.05;  ///< the model file's

plant_sim::ModelFile servo() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/velocity_servo.toml");
  *model.value("time_constant_s") = 0.0;
  model.step_s = kTs;
  return model;
}

FreeParameter gain() {
  return {"gain_mps_per_V", ParameterScale::logarithmic, kGain, -1.0, 1.0, 0.0, kNone};
}
FreeParameter offset() {
  return {"null_bias.offset_V", ParameterScale::linear, 0.05, -200.0, 200.0, 0.0, kNone};
}

/// sum of u Ts up to each sample, and time: the two columns of the position.
struct Columns {
  VectorXd command_Vs;
  VectorXd t_s;
};

/// Noise with memory `phi` from sample to sample and standard deviation noise_m; none at the start.
FitDataset made(double gain_mps_per_V, double offset_V, double noise_m, unsigned seed,
                double phi = 0.0, Columns* columns = nullptr, std::size_t samples = 2000) {
  std::mt19937 random(seed);
  std::normal_distribution<double> white(0.0, noise_m * std::sqrt(1.0 - phi * phi));
  Dataset m;
  m.name = "made";
  m.sample_time_s = kTs;
  m.starts = {0};
  double sum_Vs = 0.0;
  double noise = 0.0;
  if (columns != nullptr) {
    columns->command_Vs.resize(static_cast<Index>(samples));
    columns->t_s.resize(static_cast<Index>(samples));
  }
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = static_cast<double>(k) * kTs;
    if (columns != nullptr) {
      columns->command_Vs[static_cast<Index>(k)] = sum_Vs;
      columns->t_s[static_cast<Index>(k)] = t_s;
    }
    const double u_V = 1.3 * std::sin(2.1 * t_s) + 0.5 * std::sin(9.0 * t_s + 1.0);
    m.t_s.push_back(t_s);
    m.u_V.push_back(u_V);
    m.y_m.push_back(0.3 + gain_mps_per_V * (sum_Vs + offset_V * t_s) + noise);
    m.valid.push_back(k < 100 ? 0 : 1);
    sum_Vs += u_V * kTs;
    noise = phi * noise + white(random);
  }
  return fit_dataset({m}, {});
}

FitOptions freely() {
  FitOptions options;
  options.observer_per_s = 0.0;
  options.tolerance = 1e-12;
  return options;
}

VectorXd position_m(const FitDataset& data) {
  const std::vector<double>& y = data.records[0].y_m;
  return Eigen::Map<const VectorXd>(y.data(), static_cast<Index>(y.size())).array() - y[0];
}

TEST(Fit, IsLinearLeastSquaresWhereThePositionIsLinear) {
  Columns columns;
  const FitDataset e = made(0.0537, -0.021, 4e-4, 5, 0.0, &columns);
  for (const VectorXd& weights : {e.training_mask, e.all_mask}) {
    const FitSummary fitted =
        fit(servo(), e, weights, {gain(), offset()}, VectorXd::Zero(2), freely());
    MatrixXd a(e.size(), 2);
    a << columns.command_Vs, columns.t_s;
    const VectorXd root = weights.cwiseSqrt();
    const VectorXd c = (root.asDiagonal() * a)
                           .eval()
                           .colPivHouseholderQr()
                           .solve(root.cwiseProduct(position_m(e)));
    EXPECT_NEAR(fitted.value("gain_mps_per_V"), c[0], 1e-6 * c[0]);
    EXPECT_NEAR(fitted.value("null_bias.offset_V"), c[1] / c[0], 1e-6);
    const VectorXd expected_m = position_m(e) - a * c;
    EXPECT_LT((fitted.residual_m - expected_m).cwiseProduct(e.all_mask).cwiseAbs().maxCoeff(),
              1e-8);
    EXPECT_NEAR(fitted.training_rms_m, rms(expected_m, weights), 1e-9);
    EXPECT_NEAR(fitted.validation_rms_m, rms(expected_m, e.validation_mask), 1e-9);
  }
}

TEST(Fit, GivesTheSameFromFarAwayAndOnSeveralThreads) {
  const FitDataset e = made(0.0537, -0.021, 4e-6, 5);
  const FitSummary near =
      fit(servo(), e, e.training_mask, {gain(), offset()}, VectorXd::Zero(2), freely());
  FitOptions options = freely();
  options.width = wide(2);
  VectorXd start(2);
  start << 7.0, -30.0;  // the gain's is beyond its bound
  const FitSummary far = fit(servo(), e, e.training_mask, {gain(), offset()}, start, options);
  EXPECT_NEAR(far.theta[0], near.theta[0], 1e-7);
  EXPECT_NEAR(far.theta[1], near.theta[1], 1e-6);
}

TEST(Fit, WeighsThePriorAgainstTheRecord) {
  constexpr double kNoise_m = 0.02;
  Columns columns;
  const FitDataset e = made(kGain, 0.05, kNoise_m, 7, 0.0, &columns);
  FreeParameter p = offset();
  p.prior_mean = 1.06;
  p.prior_sd = 0.03;
  const FitSummary fitted =
      fit(servo(), e, e.training_mask, {p}, VectorXd::Constant(1, 1.06), freely());
  const VectorXd x = (kGain * p.unit * columns.t_s).cwiseProduct(e.training_mask);
  const VectorXd y = position_m(e) - kGain * columns.command_Vs;
  const double of_record = 1.0 / (fitted.sigma_m * fitted.sigma_m);
  const double of_prior = 1.0 / (p.prior_sd * p.prior_sd);
  const double expected =
      (x.dot(y) * of_record + p.prior_mean * of_prior) / (x.squaredNorm() * of_record + of_prior);
  EXPECT_NEAR(fitted.theta[0], expected, 1e-4);
  EXPECT_GT(std::abs(expected - p.prior_mean), 0.005);  // neither of the two decides alone
  EXPECT_GT(std::abs(expected - x.dot(y) / x.squaredNorm()), 0.005);
  EXPECT_NEAR(fitted.sigma_m, kNoise_m, 0.1 * kNoise_m);
}

TEST(Fit, StopsAtABoundAndSaysSo) {
  const FitDataset e = made(0.0537, 0.0, 1e-5, 3);
  FreeParameter p = gain();
  p.upper = 0.03;  // log(0.0537 / 0.05) is 0.071
  const FitSummary fitted =
      fit(servo(), e, e.training_mask, {p, offset()}, VectorXd::Zero(2), freely());
  EXPECT_EQ(fitted.theta[0], 0.03);
  EXPECT_THAT(fitted.at_bound, testing::ElementsAre(1, 0));
  const VectorXd errors = std_errors(e, e.training_mask, fitted);
  EXPECT_TRUE(std::isnan(errors[0]));
  EXPECT_TRUE(std::isfinite(errors[1]));
}

TEST(Fit, KeepsWhatItHasWhenItIsCancelled) {
  const FitDataset e = made(0.0537, 0.0, 1e-5, 3);
  FitOptions options = freely();
  options.cancel = [] { return true; };
  const FitSummary fitted =
      fit(servo(), e, e.training_mask, {gain()}, VectorXd::Constant(1, 0.2), options);
  EXPECT_EQ(fitted.theta[0], 0.2);
  EXPECT_EQ(fitted.residual_m.size(), e.size());
}

/// Scatter of the values found in new noise each time over their standard errors, for gain and
/// offset.
VectorXd scatter_over_error(double phi) {
  constexpr int kDraws = 100;
  MatrixXd x(2, kDraws);
  VectorXd error = VectorXd::Zero(2);
  for (int i = 0; i < kDraws; ++i) {
    const FitDataset e = made(0.0537, -0.021, 5e-5, 100U + static_cast<unsigned>(i), phi);
    const FitSummary fitted =
        fit(servo(), e, e.all_mask, {gain(), offset()}, VectorXd::Zero(2), freely());
    x.col(i) = fitted.theta;
    error += std_errors(e, e.all_mask, fitted) / kDraws;
  }
  const MatrixXd off = x.colwise() - x.rowwise().mean();
  const VectorXd scatter = (off.rowwise().squaredNorm() / (kDraws - 1)).cwiseSqrt();
  return scatter.cwiseQuotient(error);
}

// 100 draws know a standard deviation to 7 %.
TEST(StdErrors, AreTheScatterOfTheValuesInWhiteNoise) {
  const VectorXd ratio = scatter_over_error(0.0);
  EXPECT_NEAR(ratio[0], 1.0, 0.2);
  EXPECT_NEAR(ratio[1], 1.0, 0.2);
}

TEST(StdErrors, AreTheScatterOfTheValuesInNoiseWithMemory) {
  const VectorXd ratio = scatter_over_error(0.9);
  EXPECT_NEAR(ratio[0], 1.0, 0.3);
  EXPECT_NEAR(ratio[1], 1.0, 0.3);
}

/// x(k+1) = phi x(k) + w(k), some gaps in what counts.
double factor_of(double phi) {
  constexpr Index kSamples = 200000;
  std::mt19937 random(9);
  std::normal_distribution<double> white(0.0, 1.0);
  VectorXd x(kSamples);
  VectorXd weights = VectorXd::Ones(kSamples);
  double value = 0.0;
  for (Index k = 0; k < kSamples; ++k) {
    value = phi * value + white(random);
    x[k] = k % 100 == 50 ? 1e6 : value;
    if (k % 100 == 50) weights[k] = 0.0;
  }
  return correlation_factor(x, weights);
}

TEST(CorrelationFactor, IsThatOfAFirstOrderProcess) {
  for (const double phi : {0.3, 0.7, 0.95}) {
    const double expected = (1.0 + phi) / (1.0 - phi);
    EXPECT_NEAR(factor_of(phi), expected, 0.05 * expected) << phi;
  }
  EXPECT_NEAR(factor_of(0.0), 1.0, 0.02);
}

TEST(CorrelationFactor, StaysBetweenOneAndAHundred) {
  EXPECT_EQ(factor_of(-0.8), 1.0);
  EXPECT_EQ(factor_of(0.9999), 100.0);
  EXPECT_EQ(correlation_factor(VectorXd::Zero(50), VectorXd::Ones(50)), 1.0);
}

TEST(FitSummary, PutsItsValuesIntoTheModelAndMakesEffectsPresent) {
  FitSummary fitted;
  fitted.parameters = {gain(), offset()};
  fitted.theta.resize(2);
  fitted.theta << std::log(1.1), 2.0;
  plant_sim::ModelFile model = with_values(servo(), fitted);
  EXPECT_NEAR(*model.value("gain_mps_per_V"), 0.055, 1e-12);
  EXPECT_DOUBLE_EQ(*model.value("null_bias.offset_V"), 0.1);
  const auto present = [](const plant_sim::ModelFile::Effect& effect) {
    return effect.name == "null_bias" && effect.present;
  };
  EXPECT_TRUE(std::any_of(model.effects.begin(), model.effects.end(), present));
  EXPECT_TRUE(std::isnan(fitted.value("deadband.half_width_V")));
}

}  // namespace
}  // namespace estimator::greybox
