#include "hal/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace hal {
namespace {

/// Width of a bucket against its lower edge.
constexpr double kBucket = 1.0 / 64;

TEST(Histogram, QuantilesAreThoseOfTheSortedTimesToOneBucket) {
  std::mt19937 random(5);
  std::lognormal_distribution<double> times(std::log(20e3), 1.5);
  Histogram histogram;
  std::vector<std::int64_t> sorted;
  for (int i = 0; i < 20000; ++i) {
    sorted.push_back(static_cast<std::int64_t>(times(random)));
    histogram.add(sorted.back());
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double q : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * 20000.0)) - 1;
    const auto exact = static_cast<double>(sorted[rank]);
    const auto ours = static_cast<double>(histogram.quantile_ns(q));
    EXPECT_GE(ours, exact) << q;
    EXPECT_LE(ours, exact * (1.0 + kBucket) + 1.0) << q;
  }
  EXPECT_EQ(histogram.max_ns(), sorted.back());
  EXPECT_EQ(histogram.count(), 20000U);
}

TEST(Histogram, TakesAnyTimeAtAll) {
  Histogram histogram;
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  for (const std::int64_t t : {std::int64_t{-5}, std::int64_t{0}, INT64_MAX}) histogram.add(t);
  EXPECT_EQ(histogram.count(), 3U);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), INT64_MAX);
}

TEST(Histogram, HasNoHoleBetweenBuckets) {
  for (std::int64_t t = 1; t < (std::int64_t{1} << 39); t = t + 1 + t / 50) {
    Histogram histogram;
    histogram.add(t);
    histogram.add(INT64_MAX);  // so that the maximum does not hide the bucket's edge
    const std::int64_t edge = histogram.quantile_ns(0.5);
    ASSERT_GE(edge, t);
    ASSERT_LE(static_cast<double>(edge), static_cast<double>(t) * (1.0 + kBucket));
  }
}

}  // namespace
}  // namespace hal
