#include "estimator/sliding_window.h"

#include <gtest/gtest.h>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "tests/estimator/data.h"

namespace estimator {
namespace {

using namespace testing_data;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A fresh factorisation of the `window` samples that end at `end` (exclusive).
Estimate fresh(const Structure& s, const Data& data, int window, int end,
               std::span<const std::size_t> gaps = {}) {
  const int first = std::max(0, end - window - s.history());
  std::vector<std::size_t> shifted;
  for (const std::size_t gap : gaps) {
    if (static_cast<int>(gap) > first) shifted.push_back(gap - static_cast<std::size_t>(first));
  }
  const auto part = [&](const std::vector<double>& v) {
    return std::span(v).subspan(static_cast<std::size_t>(first),
                                static_cast<std::size_t>(end - first));
  };
  return fit_batch(s, part(data.u_V), part(data.y_m), shifted);
}

void expect_same(const Estimate& a, const Estimate& b, double relative) {
  ASSERT_EQ(a.valid, b.valid) << to_string(a.reason) << to_string(b.reason);
  ASSERT_EQ(a.samples, b.samples);
  EXPECT_NEAR(a.condition / b.condition, 1.0, 1e-7);
  EXPECT_NEAR(a.residual_rms_m / b.residual_rms_m, 1.0, 1e-7);
  double norm = 0.0;
  double difference = 0.0;
  for (int i = 0; i < a.size; ++i) {
    norm += b.value[i] * b.value[i];
    difference += (a.value[i] - b.value[i]) * (a.value[i] - b.value[i]);
    EXPECT_NEAR(a.std_error[i] / b.std_error[i], 1.0, 1e-7);
    EXPECT_NEAR(a.value[i], b.value[i], 1e-6 * b.std_error[i]);
  }
  EXPECT_LT(std::sqrt(difference / norm), relative);
}

TEST(SlidingWindow, AgreesWithAFreshFactorisationAtEveryStride) {
  const Data data = excited(1500, 1e-6, 3);
  for (const Structure s : {Structure{1, 1, 1, false}, kTruth, Structure{4, 4, 1, true}}) {
    for (const auto& [window, stride] : {std::pair{400, 1},
                                         {400, 10},
                                         {400, 40},
                                         {400, 400},
                                         {399, 1},
                                         {120, 45},
                                         {101, 100},
                                         {50, 7},
                                         {30, 30}}) {
      SlidingWindow sliding({s, window, stride, {}});
      int seen = 0;
      for (int t = 0; t < 1500; ++t) {
        const bool due = sliding.push(data.u_V[t], data.y_m[t]);
        ASSERT_EQ(due, (t + 1) % stride == 0);
        if (!due || t + 1 < window + s.history() || (stride < 10 && t % 11 != 0)) continue;
        expect_same(sliding.estimate(), fresh(s, data, window, t + 1), 1e-11);
        ++seen;
      }
      EXPECT_GE(seen, 2) << window << " " << stride;
      ASSERT_FALSE(HasFatalFailure()) << s.text() << " " << window << " " << stride;
    }
  }
}

TEST(SlidingWindow, AgreesWithAFreshFactorisationAfterMillionsOfIllConditionedSamples) {
  // A slow sine and a little noise: condition in the hundred thousands. Two backward stable
  // factorisations may differ by some condition * epsilon, here 1e-10.
  constexpr int kSamples = 2'000'000;
  constexpr int kWindow = 400;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  Data data;
  const Structure s{2, 2, 1, false};
  for (int t = 0; t < kSamples; ++t) {
    data.u_V.push_back(5.0 * std::sin(0.01 * t) + 1e-3 * normal(random));
  }
  data.y_m = simulate(s, {-1.99, 0.9902, 2e-4, -1.9e-4}, data.u_V, 1e-8, random);
  SlidingWindow sliding({s, kWindow, 1, {}});
  double worst_condition = 0.0;
  for (int t = 0; t < kSamples; ++t) {
    sliding.push(data.u_V[t], data.y_m[t]);
    if (t + 1 < kSamples - 300 && (t % 100'003 != 0 || t < 1000)) continue;
    const Estimate ours = sliding.estimate();
    worst_condition = std::max(worst_condition, ours.condition);
    expect_same(ours, fresh(s, data, kWindow, t + 1), 1e-9);
    ASSERT_FALSE(HasFailure()) << t;
  }
  EXPECT_GT(worst_condition, 1e5);
}

TEST(SlidingWindow, ForgetsAWildValueOnceItHasLeft) {
  Data data = excited(2000, 1e-6, 4);
  data.y_m[700] = 1e30;
  data.u_V[900] = 1e200;  // its square is beyond double arithmetic
  SlidingWindow sliding({kTruth, 400, 1, {}});
  for (int t = 0; t < 2000; ++t) {
    sliding.push(data.u_V[t], data.y_m[t]);
    if (t == 950) {
      EXPECT_EQ(sliding.estimate().reason, Reason::not_finite);
    }
    if (t >= 900 + 400 + 2) {
      expect_same(sliding.estimate(), fresh(kTruth, data, 400, t + 1), 1e-11);
    }
    ASSERT_FALSE(HasFailure()) << t;
  }
}

TEST(SlidingWindow, DropsRowsAcrossGapsAndCountsTheMissingTime) {
  const Data data = excited(900, 1e-6, 6);
  Data with_gap;  // the same with 30 samples lost after 500, as missing values
  for (int t = 0; t < 900; ++t) {
    const bool lost = t >= 500 && t < 530;
    with_gap.u_V.push_back(lost ? kNan : data.u_V[t]);
    with_gap.y_m.push_back(lost ? kNan : data.y_m[t]);
  }
  SlidingWindow by_gap({kTruth, 300, 10, {}});
  SlidingWindow by_nan({kTruth, 300, 10, {}});
  int compared = 0;
  for (int t = 0; t < 900; ++t) {
    const bool due = by_nan.push(with_gap.u_V[t], with_gap.y_m[t]);
    if (t == 500) {
      EXPECT_TRUE(by_gap.gap(30));
    }
    if (t >= 500 && t < 530) continue;
    EXPECT_EQ(by_gap.push(data.u_V[t], data.y_m[t]), due);
    if (!due || t < 310) continue;
    const Estimate expected = fresh(kTruth, with_gap, 300, t + 1);
    expect_same(by_gap.estimate(), expected, 1e-11);
    expect_same(by_nan.estimate(), expected, 1e-11);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(SlidingWindow, SaysWhyItHasNoValidEstimate) {
  const Data data = excited(3000, 1e-6, 7);
  SlidingWindow sliding({kTruth, 400, 20, {}});
  int t = 0;
  const auto feed = [&](int count) {
    for (int i = 0; i < count; ++i, ++t) sliding.push(data.u_V[t], data.y_m[t]);
    return sliding.estimate();
  };
  EXPECT_EQ(sliding.estimate().reason, Reason::too_short);
  EXPECT_EQ(feed(399).reason, Reason::too_short);
  EXPECT_EQ(feed(1).reason, Reason::none);
  sliding.gap(250);
  EXPECT_EQ(sliding.estimate().reason, Reason::gap);
  EXPECT_EQ(sliding.estimate().samples, 160);  // the last due moment: 240 of 250 lost so far
  EXPECT_EQ(feed(400).reason, Reason::none);
  EXPECT_TRUE(sliding.gap(1'000'000'000'000LL));
  EXPECT_EQ(sliding.estimate().samples, 0);
  EXPECT_EQ(feed(410).reason, Reason::none);
  for (int i = 0; i < 420; ++i) sliding.push(0.0, 0.305);
  EXPECT_EQ(sliding.estimate().reason, Reason::not_excited);
  sliding.reset();
  EXPECT_EQ(sliding.estimate().reason, Reason::too_short);
  EXPECT_EQ(feed(402).reason, Reason::none);
}

TEST(SlidingWindow, RefusesAWindowOrStrideOutOfRange) {
  for (const auto& [window, stride] :
       {std::pair{0, 1}, {400, 0}, {400, 401}, {400, -1}, {-5, -5}, {10'000'001, 1}}) {
    EXPECT_THROW(SlidingWindow({kTruth, window, stride, {}}), config::schema::Error);
  }
}

}  // namespace
}  // namespace estimator
