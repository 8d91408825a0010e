#include "estimator/batch.h"

#include <gtest/gtest.h>

#include "estimator/free_run.h"
#include "tests/estimator/data.h"
#include "tests/estimator/reference/numbers.h"

namespace estimator {
namespace {

using namespace testing_data;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Batch, AgreesWithNumPyInCoefficientsErrorsAndCondition) {
  const Estimate fit = fit_batch({3, 2, 2, true}, lcg(200, 1), lcg(200, 2));
  ASSERT_TRUE(fit.valid) << to_string(fit.reason);
  ASSERT_EQ(fit.size, 6);
  EXPECT_EQ(fit.samples, 197);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(fit.value[i], reference::kRandomTheta[i], 1e-14);
    EXPECT_NEAR(fit.std_error[i], reference::kRandomStdError[i], 1e-14);
  }
  EXPECT_NEAR(fit.condition, reference::kRandomCondition, 1e-12);
  EXPECT_NEAR(fit.residual_rms_m, reference::kRandomRms, 1e-14);
}

TEST(Batch, KeepsTheDigitsThatExactArithmeticSaysIllConditionedDataLeave) {
  std::vector<double> u_V;
  for (int t = 0; t < 40; ++t) u_V.push_back(std::pow(t - 20, 9));
  const Estimate fit = fit_batch({0, 9, 1, false}, u_V, lcg(40, 3));
  ASSERT_TRUE(fit.valid) << to_string(fit.reason);
  EXPECT_NEAR(fit.condition / reference::kPolynomialCondition, 1.0, 1e-6);
  // Orthogonal: errors of some condition * epsilon; normal equations would lose condition^2.
  const double tolerance = 100 * 2.2e-16 * reference::kPolynomialCondition;
  ASSERT_LT(tolerance, 1e-4);
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(fit.value[i] / reference::kPolynomialTheta[i], 1.0, tolerance) << i;
  }
}

TEST(Batch, RecoversEveryOrderUpToTenWithoutNoise) {
  std::mt19937_64 random(3);
  for (const bool constant : {false, true}) {
    for (int order = 1; order <= kMaxOrder; ++order) {
      const Structure s{order, order, 1 + order % 3, constant};
      std::vector<double> theta;
      for (int i = 0; i < s.size(); ++i) theta.push_back(0.5 / order * ((i % 3) - 1.2));
      const std::vector<double> u_V = lcg(1000, 7);
      const std::vector<double> y_m = simulate(s, theta, u_V, 0.0, random);
      const Estimate fit = fit_batch(s, u_V, y_m);
      ASSERT_TRUE(fit.valid) << s.text() << to_string(fit.reason);
      for (int i = 0; i < s.size(); ++i) EXPECT_NEAR(fit.value[i], theta[i], 1e-10) << s.text();
      EXPECT_LT(fit.residual_rms_m, 1e-14);
    }
  }
}

TEST(Batch, FlagsTheNoiseFreeSineAsUndeterminedAndItsFreeRunStaysSound) {
  Data data = sine_loop(4000, 0.0);
  data.u_V.erase(data.u_V.begin(), data.u_V.begin() + 3600);  // start-up transient gone
  data.y_m.erase(data.y_m.begin(), data.y_m.begin() + 3600);
  for (const Structure s : {Structure{2, 2, 1, false}, Structure{4, 4, 1, false}}) {
    const Estimate fit = fit_batch(s, data.u_V, data.y_m);
    EXPECT_FALSE(fit.valid);
    EXPECT_EQ(fit.reason, Reason::rank_deficient);
    EXPECT_GT(fit.condition, 1e10);
    EXPECT_TRUE(std::isnan(fit.std_error[0]));
    const auto run =
        free_run(s, {fit.value.data(), static_cast<std::size_t>(fit.size)}, data.u_V, data.y_m);
    EXPECT_LT(compare(data.y_m, run, s.history()).rms_m, 1e-9) << s.text();
  }
  // One input and one output coefficient are determined: y(t) = y(t-1) + 2e-4 u(t-1).
  const Estimate simple = fit_batch({1, 1, 1, false}, data.u_V, data.y_m);
  ASSERT_TRUE(simple.valid);
  EXPECT_NEAR(simple.value[0], -1.0, 1e-11);
  EXPECT_NEAR(simple.value[1], 2e-4, 1e-14);
}

TEST(Batch, SaysWhyDataGiveNoEstimate) {
  const std::vector<double> moving = lcg(100, 1);
  const std::vector<double> still(100, 0.305);
  const std::vector<double> zero(100, 0.0);
  const std::vector<double> missing(100, kNan);
  std::vector<double> huge = moving;
  huge[50] = 1e200;
  const auto reason = [](const std::vector<double>& u_V, const std::vector<double>& y_m,
                         const Structure& s = {2, 1, 1, true}) {
    const Estimate fit = fit_batch(s, u_V, y_m);
    EXPECT_FALSE(fit.valid);
    return fit.reason;
  };
  EXPECT_EQ(reason({}, {}), Reason::too_short);
  EXPECT_EQ(reason(lcg(6, 1), lcg(6, 2)), Reason::too_short);
  EXPECT_EQ(reason(missing, moving), Reason::too_short);
  EXPECT_EQ(reason(zero, zero), Reason::not_excited);
  EXPECT_EQ(reason(zero, moving), Reason::not_excited);
  EXPECT_EQ(reason(moving, still), Reason::not_excited);
  EXPECT_EQ(reason(moving, still, {1, 1, 1, false}), Reason::not_excited);
  EXPECT_EQ(reason(moving, huge), Reason::not_finite);
  EXPECT_EQ(fit_batch({2, 1, 1, true}, lcg(7, 1), lcg(7, 2)).samples, 5);
  EXPECT_TRUE(fit_batch({2, 1, 1, false}, lcg(7, 1), lcg(7, 2)).valid);
}

TEST(Batch, AppliesTheExcitationLimitsItIsGiven) {
  const Data data = excited(500, 1e-6, 1);
  const auto reason = [&](Limits limits) {
    return fit_batch(kTruth, data.u_V, data.y_m, {}, limits).reason;
  };
  EXPECT_EQ(reason({}), Reason::none);
  EXPECT_EQ(reason({.min_span_u_V = 100.0}), Reason::not_excited);
  EXPECT_EQ(reason({.min_span_y_m = 1.0}), Reason::not_excited);
  EXPECT_EQ(reason({.max_condition = 1.5}), Reason::rank_deficient);
}

TEST(Batch, LeavesOutEveryRowAcrossAGapOrAMissingValue) {
  // Two records of the same plant put together: only across the seam the equation does not hold.
  Data data = excited(400, 0.0, 1);
  const Data other = excited(300, 0.0, 2);
  data.u_V.insert(data.u_V.end(), other.u_V.begin(), other.u_V.end());
  data.y_m.insert(data.y_m.end(), other.y_m.begin(), other.y_m.end());
  data.y_m[100] = kNan;
  data.u_V[550] = kNan;
  const std::size_t seam = 400;
  const Estimate fit = fit_batch(kTruth, data.u_V, data.y_m, {&seam, 1});
  ASSERT_TRUE(fit.valid);
  EXPECT_EQ(fit.samples, 700 - 2 - 2 - 3 - 3);
  for (int i = 0; i < fit.size; ++i) EXPECT_NEAR(fit.value[i], kTruthTheta[i], 1e-12);
  EXPECT_GT(fit_batch(kTruth, data.u_V, data.y_m).residual_rms_m, 1e3 * fit.residual_rms_m);
}

TEST(Batch, GivesOneEstimatePerWholePeriodWithHistoryFromTheOneBefore) {
  const Data data = excited(1250, 1e-6, 5);
  const std::vector<Estimate> periods = fit_periods(kTruth, data.u_V, data.y_m, 400);
  ASSERT_EQ(periods.size(), 3U);
  EXPECT_EQ(periods[0].samples, 398);
  EXPECT_EQ(periods[1].samples, 400);
  EXPECT_EQ(periods[2].samples, 400);
  const auto from = [&](std::size_t first) {
    return fit_batch(kTruth, std::span(data.u_V).subspan(first - 2, 402),
                     std::span(data.y_m).subspan(first - 2, 402));
  };
  for (int i = 0; i < periods[1].size; ++i) {
    EXPECT_DOUBLE_EQ(periods[1].value[i], from(400).value[i]);
    EXPECT_DOUBLE_EQ(periods[2].value[i], from(800).value[i]);
  }
}

}  // namespace
}  // namespace estimator
