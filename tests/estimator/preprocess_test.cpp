#include "estimator/preprocess.h"

#include <gtest/gtest.h>

#include <complex>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "tests/estimator/data.h"
#include "tests/estimator/reference/numbers.h"

namespace estimator {
namespace {

using namespace testing_data;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FilterDesign design(Band band, int order, double low_Hz, double high_Hz) {
  return {.band = band, .order = order, .low_Hz = low_Hz, .high_Hz = high_Hz, .sample_Hz = 200.0};
}

template <std::size_t kCount>
void expect_every_seventh(const FilterDesign& d, const double (&expected)[kCount]) {
  std::vector<double> values = lcg(64, 4);
  apply_filter(Filter(d), values);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(values[7 * i], expected[i], 1e-12) << "order " << d.order << " at " << 7 * i;
  }
}

TEST(Filter, AgreesWithSciPyForEveryBandAndParity) {
  expect_every_seventh(design(Band::low_pass, 4, 0, 10), reference::kLowPass4);
  expect_every_seventh(design(Band::low_pass, 5, 0, 30), reference::kLowPass5);
  expect_every_seventh(design(Band::high_pass, 3, 2, 0), reference::kHighPass3);
  expect_every_seventh(design(Band::high_pass, 6, 40, 0), reference::kHighPass6);
  expect_every_seventh(design(Band::band_pass, 1, 5, 20), reference::kBandPass1);
  expect_every_seventh(design(Band::band_pass, 3, 5, 20), reference::kBandPass3);
  expect_every_seventh(design(Band::band_pass, 1, 1, 90), reference::kBandPass1Wide);
  expect_every_seventh(design(Band::band_pass, 8, 10, 60), reference::kBandPass8);
}

/// |H| at a frequency, from the sections.
double gain(const Filter& filter, double frequency_Hz) {
  const auto w = std::polar(1.0, -2.0 * 3.14159265358979 * frequency_Hz / 200.0);
  std::complex<double> out = 1.0;
  for (int i = 0; i < filter.sections(); ++i) {
    const Biquad& q = filter.section(i);
    out *= (q.b0 + w * (q.b1 + w * q.b2)) / (1.0 + w * (q.a1 + w * q.a2));
  }
  return std::abs(out);
}

TEST(Filter, HasTheButterworthMagnitudeAtEveryOrder) {
  // |H|^2 = 1 / (1 + (tan(pi f / fs) / tan(pi fc / fs))^(2 order)) for the low-pass
  for (int order = 1; order <= 8; ++order) {
    const Filter low(design(Band::low_pass, order, 0, 20));
    const Filter high(design(Band::high_pass, order, 20, 0));
    for (const double f : {0.5, 5.0, 20.0, 45.0, 90.0}) {
      const double ratio = std::tan(M_PI * f / 200.0) / std::tan(M_PI * 20.0 / 200.0);
      EXPECT_NEAR(gain(low, f), 1.0 / std::sqrt(1.0 + std::pow(ratio, 2 * order)), 1e-12);
      EXPECT_NEAR(gain(high, f), 1.0 / std::sqrt(1.0 + std::pow(ratio, -2 * order)), 1e-12);
    }
    const Filter band(design(Band::band_pass, order, 5, 20));
    EXPECT_NEAR(gain(band, 5), std::sqrt(0.5), 1e-12) << order;
    EXPECT_NEAR(gain(band, 20), std::sqrt(0.5), 1e-12) << order;
  }
}

TEST(Filter, StartsSettledOnTheFirstSample) {
  Filter low(design(Band::low_pass, 5, 0, 2));
  Filter high(design(Band::high_pass, 4, 1, 0));
  for (int i = 0; i < 1000; ++i) {
    EXPECT_NEAR(low.push(0.305), 0.305, 1e-12);
    EXPECT_NEAR(high.push(0.305), 0.0, 1e-12);
  }
}

TEST(Filter, RefusesOrdersAndCornersOutOfRange) {
  const auto refused = [](const FilterDesign& d) {
    EXPECT_THROW(Filter{d}, config::schema::Error);
  };
  refused(design(Band::low_pass, 0, 0, 10));
  refused(design(Band::low_pass, 9, 0, 10));
  refused(design(Band::low_pass, 4, 0, 100));
  refused(design(Band::low_pass, 4, 0, kNan));
  refused(design(Band::high_pass, 4, 0, 10));
  refused(design(Band::band_pass, 4, 20, 10));
  refused({.band = Band::low_pass, .order = 4, .low_Hz = 0, .high_Hz = 1, .sample_Hz = 0});
}

TEST(Detrend, AgreesWithSciPy) {
  std::vector<double> values = lcg(50, 5);
  for (int t = 0; t < 50; ++t) values[t] += 3.0 + 0.25 * t;
  std::vector<double> line = values;
  remove_mean(values);
  remove_line(line);
  for (int t = 0; t < 50; ++t) {
    EXPECT_NEAR(values[t], reference::kDetrendMean[t], 1e-13);
    EXPECT_NEAR(line[t], reference::kDetrendLine[t], 1e-13);
  }
}

TEST(Detrend, ReturnsWhatItTookAwayAndLeavesMissingValuesOut) {
  std::vector<double> values;
  for (int t = 0; t < 100; ++t) values.push_back(t % 7 == 3 ? kNan : 0.305 + 1e-3 * t);
  std::vector<double> mean = values;
  const Line line = remove_line(values);
  EXPECT_NEAR(line.offset, 0.305, 1e-14);
  EXPECT_NEAR(line.slope, 1e-3, 1e-16);
  EXPECT_TRUE(std::isnan(values[3]));
  EXPECT_NEAR(values[99], 0.0, 1e-15);
  double sum = 0.0;
  int count = 0;
  for (const double v : mean) {
    if (!std::isnan(v)) {
      sum += v;
      ++count;
    }
  }
  EXPECT_NEAR(remove_mean(mean), sum / count, 1e-15);
  std::vector<double> none;
  EXPECT_EQ(remove_mean(none), 0.0);
  EXPECT_EQ(remove_line(none).slope, 0.0);
  std::vector<double> one{5.0};
  EXPECT_EQ(remove_line(one).offset, 5.0);
}

TEST(Decimate, AgreesWithSciPyFilteringAndSlicing) {
  const std::vector<double> out = decimate(lcg(200, 6), 4);
  ASSERT_EQ(out.size(), std::size(reference::kDecimated4));
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_NEAR(out[i], reference::kDecimated4[i], 1e-12);
  }
}

TEST(Decimate, KeepsTheBandBelowAndRemovesWhatWouldFoldBack) {
  std::vector<double> slow;
  std::vector<double> fast;
  for (int t = 0; t < 4000; ++t) {
    slow.push_back(std::sin(2.0 * M_PI * 2.0 * t / 200.0));
    fast.push_back(std::sin(2.0 * M_PI * 38.0 * t / 200.0));  // folds to 2 Hz at 40 Hz
  }
  const auto peak = [](const std::vector<double>& v) {
    double out = 0.0;
    for (std::size_t i = v.size() / 2; i < v.size(); ++i) out = std::max(out, std::abs(v[i]));
    return out;
  };
  EXPECT_NEAR(peak(decimate(slow, 5)), 1.0, 1e-3);
  EXPECT_LT(peak(decimate(fast, 5)), 1e-3);
  EXPECT_EQ(decimate(slow, 1), slow);
  EXPECT_THROW((void)decimate(slow, 0), config::schema::Error);
}

TEST(Preprocess, GivesOnLineWhatTheVectorsGiveOffLine) {
  std::vector<double> u_V = lcg(1000, 1);
  std::vector<double> y_m = lcg(1000, 2);
  const FilterDesign band = design(Band::band_pass, 2, 1, 15);
  Preprocess stream(
      {.offset_u_V = 0.1, .offset_y_m = 0.305, .filter = true, .design = band, .decimation = 4});
  std::vector<double> out_u;
  std::vector<double> out_y;
  for (int t = 0; t < 1000; ++t) {
    if (!stream.push(u_V[t], y_m[t])) continue;
    EXPECT_EQ(t % 4, 0);
    out_u.push_back(stream.u_V());
    out_y.push_back(stream.y_m());
  }
  for (double& v : u_V) v -= 0.1;
  for (double& v : y_m) v -= 0.305;
  apply_filter(Filter(band), u_V);
  apply_filter(Filter(band), y_m);
  EXPECT_EQ(out_u, decimate(u_V, 4));
  EXPECT_EQ(out_y, decimate(y_m, 4));
}

TEST(Preprocess, FilteringBothSidesLeavesTheDifferenceEquationAsItIs) {
  Data data = excited(4000, 0.0, 3);
  const Filter low(design(Band::low_pass, 4, 0, 30));
  apply_filter(low, data.u_V);
  apply_filter(low, data.y_m);
  // After the start-up transient of the two filters.
  const Estimate fit =
      fit_batch(kTruth, std::span(data.u_V).subspan(200), std::span(data.y_m).subspan(200));
  ASSERT_TRUE(fit.valid) << to_string(fit.reason);
  for (int i = 0; i < fit.size; ++i) EXPECT_NEAR(fit.value[i], kTruthTheta[i], 1e-9);
}

TEST(Preprocess, MarksAMissingSampleAndKeepsItsGrid) {
  Preprocess stream({.design = {}, .decimation = 4});
  std::vector<double> out;
  for (int t = 0; t < 24; ++t) {
    if (stream.push(1.0, t == 9 ? kNan : 2.0)) out.push_back(stream.y_m());
  }
  ASSERT_EQ(out.size(), 6U);
  EXPECT_TRUE(std::isnan(out[3]));  // t = 12, the first after the loss
  for (const int i : {0, 1, 2, 4, 5}) EXPECT_NEAR(out[i], 2.0, 1e-12) << i;
}

TEST(Preprocess, CountsTheOutputsThatFallIntoAGap) {
  for (int before = 1; before < 9; ++before) {
    for (int lost = 0; lost < 15; ++lost) {
      Preprocess by_gap({.design = {}, .decimation = 4});
      Preprocess by_nan({.design = {}, .decimation = 4});
      for (int t = 0; t < before; ++t) {
        by_gap.push(1.0, 2.0);
        by_nan.push(1.0, 2.0);
      }
      long long outputs = 0;
      for (int t = 0; t < lost; ++t) outputs += by_nan.push(kNan, kNan) ? 1 : 0;
      EXPECT_EQ(by_gap.gap(lost), outputs);
      bool marked = outputs > 0;
      for (int t = 0; t < 12; ++t) {
        const bool due = by_nan.push(1.0, 2.0);
        ASSERT_EQ(by_gap.push(1.0, 2.0), due);
        if (!due || lost == 0) continue;
        marked = marked || std::isnan(by_gap.y_m());
        ASSERT_TRUE(marked) << before << " " << lost;
      }
      EXPECT_NEAR(by_gap.y_m(), 2.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace estimator
