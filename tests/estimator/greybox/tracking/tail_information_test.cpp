// Tails of a window and causes of a deviation, on a linear problem with a known answer.
#include "estimator/greybox/tracking/tail_information.h"

#include <gmock/gmock.h>

#include <random>

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::ElementsAre;

constexpr Index kSamples = 2000;
constexpr double kSigma = 2e-6;

/// A window y = J theta + noise whose first parameter rises by `change` at `at`, fitted as a whole.
struct Window {
  MatrixXd jacobian = MatrixXd(kSamples, 2);
  VectorXd residual = VectorXd(kSamples);
  VectorXd theta;

  Window(double change, Index at) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (Index k = 0; k < kSamples; ++k) {
      const double phase = 0.0157 * static_cast<double>(k);
      jacobian.row(k) << -1e-6 * std::sin(phase), -1e-6 * std::cos(0.7 * phase);
      residual[k] = kSigma * normal(random);
      if (k >= at) residual[k] -= jacobian(k, 0) * change;
    }
    theta = -jacobian.colPivHouseholderQr().solve(residual);
    residual += jacobian * theta;
  }
  std::vector<TailInformation> tails() const {
    return tails_of(residual, jacobian, kSigma, kSamples, 100);
  }
};

TEST(TailInformation, AStepLeadsToTheFitOfTheTailAlone) {
  const Window window(0.0, 0);
  const std::vector<TailInformation> tails = window.tails();
  ASSERT_EQ(tails.size(), 20u);
  const TailInformation& tail = tails[4];
  ASSERT_EQ(tail.samples, 500u);
  const VectorXd alone =
      -window.jacobian.bottomRows(500).colPivHouseholderQr().solve(window.residual.tail(500));
  // the ridge of a prior that is wide against the estimate's error
  EXPECT_NEAR(tail.step()[0], alone[0], 0.02 * std::sqrt(tail.information.inverse()(0, 0)));
  EXPECT_NEAR(tail.step()[1], alone[1], 0.02 * std::sqrt(tail.information.inverse()(1, 1)));
  EXPECT_NEAR(tails.back().step().norm(), 0.0, 1e-3);
}

TEST(TailInformation, AChangeIsFoundWhereItWas) {
  EXPECT_EQ(samples_since_change(Window(0.0, 0).tails()), std::nullopt);
  const auto since = samples_since_change(Window(2.0, 1400).tails());
  ASSERT_TRUE(since.has_value());
  EXPECT_NEAR(static_cast<double>(*since), 600.0, 100.0);
}

/// Information of two parameters nearly alike: together each is known badly, alone well.
MatrixXd nearly_alike() {
  MatrixXd information(2, 2);
  information << 400.0, 380.0, 380.0, 400.0;
  return information;
}

TEST(DeviationCauses, OneCauseIsNamedThoughAllFittedTogetherAreUncertain) {
  const MatrixXd information = nearly_alike();
  const Eigen::Vector2d truth(0.4, 0.0);
  const Eigen::Vector2d least(0.03, 0.03);
  const DeviationCauses causes = causes_of(truth, information.inverse(), least, 5.0);
  EXPECT_THAT(causes.parameters, ElementsAre(0u));
  EXPECT_NEAR(causes.deviation[0], 0.4, 1e-9);
  EXPECT_NEAR(causes.std_error[0], 0.05, 1e-9);
  EXPECT_NEAR(causes.chi_square, 64.0, 1e-6);
  EXPECT_NEAR(causes.deviation[1], 0.0, 1e-9);
  EXPECT_GT(causes.std_error[1], 0.1);
}

TEST(DeviationCauses, ASmallDeviationIsNoCauseHoweverSure) {
  const MatrixXd covariance = 1e-8 * MatrixXd::Identity(2, 2);
  const Eigen::Vector2d least(0.03, 0.03);
  EXPECT_TRUE(causes_of(Eigen::Vector2d(0.02, 0.0), covariance, least, 5.0).parameters.empty());
  EXPECT_THAT(causes_of(Eigen::Vector2d(0.04, -0.05), covariance, least, 5.0).parameters,
              ElementsAre(1u, 0u));
}

TEST(DeviationCauses, AChangeThatStandsIsACauseBesideANewOne) {
  const MatrixXd information = nearly_alike();
  const Eigen::Vector2d truth(0.4, 0.1);
  const Eigen::Vector2d least(0.03, 0.03);
  const DeviationCauses alone = causes_of(truth, information.inverse(), least, 5.0);
  EXPECT_THAT(alone.parameters, ElementsAre(0u));
  EXPECT_NEAR(alone.deviation[0], 0.4 + 0.95 * 0.1, 1e-9);  // the other's effect taken for its own
  const DeviationCauses causes = causes_of(truth, information.inverse(), least, 5.0, {1});
  EXPECT_THAT(causes.parameters, ElementsAre(1u));
  EXPECT_NEAR(causes.deviation[0], 0.4, 1e-9);
  EXPECT_NEAR(causes.deviation[1], 0.1 + 0.95 * 0.4, 1e-9);  // while the new one is no cause
}

TEST(DeviationCauses, ChanceIsNoCause) {
  const MatrixXd covariance = 0.01 * MatrixXd::Identity(2, 2);
  const Eigen::Vector2d least(0.03, 0.03);
  EXPECT_TRUE(causes_of(Eigen::Vector2d(0.45, -0.3), covariance, least, 5.0).parameters.empty());
}

}  // namespace
}  // namespace estimator::greybox::tracking
