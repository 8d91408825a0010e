// The standard errors that estimators report against the errors they make: over many simulated
// records with known coefficients, (estimate - truth) / standard error must be standard normal.
#include <gtest/gtest.h>

#include "estimator/batch.h"
#include "estimator/recursive.h"
#include "estimator/sliding_window.h"
#include "tests/estimator/data.h"

namespace estimator {
namespace {

using namespace testing_data;

constexpr int kRecords = 600;
constexpr int kSamples = 1000;

template <class Estimator>
void expect_honest(const Estimator& estimate_of) {
  double sum[5] = {};
  double square[5] = {};
  for (int record = 0; record < kRecords; ++record) {
    const Data data = excited(kSamples, 1e-5, 1000 + static_cast<std::uint64_t>(record));
    const Estimate fit = estimate_of(data);
    ASSERT_TRUE(fit.valid) << to_string(fit.reason);
    for (int i = 0; i < 5; ++i) {
      const double z = (fit.value[i] - kTruthTheta[i]) / fit.std_error[i];
      sum[i] += z;
      square[i] += z * z;
    }
  }
  for (int i = 0; i < 5; ++i) {
    // Four standard deviations of the mean and of the mean square of 600 normal values; the mean
    // square gets another 10 % for the small-sample error of s^2 and of autoregressions.
    EXPECT_NEAR(sum[i] / kRecords, 0.0, 4.0 / std::sqrt(kRecords) + 0.1) << i;
    EXPECT_NEAR(square[i] / kRecords, 1.0, 4.0 * std::sqrt(2.0 / kRecords) + 0.1) << i;
  }
}

TEST(StandardErrors, AreHonestForTheBatchFit) {
  expect_honest([](const Data& data) { return fit_batch(kTruth, data.u_V, data.y_m); });
}

TEST(StandardErrors, AreHonestForTheSlidingWindow) {
  expect_honest([](const Data& data) {
    SlidingWindow sliding({kTruth, 300, 10, {}});
    for (int t = 0; t < kSamples; ++t) sliding.push(data.u_V[t], data.y_m[t]);
    return sliding.estimate();
  });
}

void expect_honest_recursive(double forgetting) {
  expect_honest([=](const Data& data) {
    // The prior is wide against theta: C large enough not to pull.
    Recursive filter(
        {.structure = kTruth, .forgetting = forgetting, .prior_variance = 1e10, .limits = {}});
    for (int t = 0; t < kSamples; ++t) filter.push(data.u_V[t], data.y_m[t]);
    return filter.estimate();
  });
}

TEST(StandardErrors, AreHonestForTheRecursiveFilterWithoutForgetting) {
  expect_honest_recursive(1.0);
}

TEST(StandardErrors, AreHonestForTheRecursiveFilterThatForgets) {
  expect_honest_recursive(0.995);
  expect_honest_recursive(0.98);
}

}  // namespace
}  // namespace estimator
