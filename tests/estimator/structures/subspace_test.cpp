#include "estimator/structures/subspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/structures/data.h"
#include "tests/estimator/structures/reference/numbers.h"

namespace estimator::structures {
namespace {

using namespace testing_data;

class Both : public testing::TestWithParam<SubspaceMethod> {};
INSTANTIATE_TEST_SUITE_P(Subspace, Both,
                         testing::Values(SubspaceMethod::n4sid, SubspaceMethod::predictor),
                         [](const auto& of) {
                           return of.param == SubspaceMethod::n4sid ? "N4sid" : "Predictor";
                         });

TEST_P(Both, FindsANoiseFreeSystemExactly) {
  Polynomial truth = armax_truth();
  truth.c.clear();
  truth.constant_m = 0.2;
  const Record record = random_record(truth, 600, 0.0, 1);
  const SubspaceFit fit =
      fit_subspace({.order = 2, .method = GetParam(), .past = 6, .future = 6}, record.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.model.a[i], truth.a[i], 1e-7);
    EXPECT_NEAR(fit.model.b[i], truth.b[i], 1e-7);
  }
  EXPECT_NEAR(fit.model.constant_m, 0.2, 1e-6);
  EXPECT_LT(fit.singular_values[2], 1e-6 * fit.singular_values[1]);
}

TEST_P(Both, AgreesWithSlicotOnNoisyData) {
  const Record record = armax_record();
  const SubspaceFit fit =
      fit_subspace({.order = 2, .constant = false, .method = GetParam(), .past = 15, .future = 15},
                   record.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  // Different weightings of the same data: within two standard errors of the efficient estimate,
  // whose order is a1 a2 b1 b2 c1 c2; c, of least weight, within four.
  const double* se = reference::kArmaxStdError;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.model.a[i], reference::kOctave_n4sid[i], 2.0 * se[i]);
    EXPECT_NEAR(fit.model.b[i], reference::kOctave_n4sid[2 + i], 2.0 * se[2 + i]);
    EXPECT_NEAR(fit.model.c[i], reference::kOctave_n4sid[4 + i], 4.0 * se[4 + i]);
  }
}

TEST(Subspace, OfThePredictorFormIsRightInClosedLoop) {
  // Strong feedback, noise as large as what the reference does: a1 and b1 over 20 records.
  const Polynomial truth{.a = {-0.9}, .b = {0.5}, .c = {0.4}, .d = {}, .f = {}};
  constexpr int kRecords = 20;
  double off[2] = {};
  double square[2] = {};
  for (int i = 0; i < kRecords; ++i) {
    std::mt19937_64 random(70 + i);
    std::normal_distribution<double> normal;
    Record record;
    double y1 = 0.0, u1 = 0.0, e1 = 0.0;
    for (int t = 0; t < 4000; ++t) {
      const double e = normal(random);
      const double y = 0.9 * y1 + 0.5 * u1 + e + 0.4 * e1;
      u1 = 0.5 * normal(random) - 1.2 * y;
      y1 = y;
      e1 = e;
      record.y_m.push_back(y);
      record.u_V.push_back(u1);
    }
    const SubspaceFit fit = fit_subspace({.order = 1}, record.all());
    ASSERT_TRUE(fit.valid) << fit.why;
    const double error[2] = {fit.model.a[0] - truth.a[0], fit.model.b[0] - truth.b[0]};
    for (int j = 0; j < 2; ++j) {
      off[j] += error[j] / kRecords;
      square[j] += error[j] * error[j] / kRecords;
    }
  }
  for (int j = 0; j < 2; ++j) {
    const double scatter = std::sqrt((square[j] - off[j] * off[j]) / (kRecords - 1));
    EXPECT_LT(std::abs(off[j]), 4.0 * scatter) << j;
    EXPECT_LT(std::sqrt(square[j]), 0.1) << j;
  }
}

TEST(Subspace, SaysWhyThereIsNoFit) {
  const std::vector<double> zero(500, 0.0);
  EXPECT_EQ(fit_subspace({}, {{zero, zero}}).why, "input or output is zero");
  const std::vector<double> few(20, 1.0);
  EXPECT_EQ(fit_subspace({}, {{few, few}}).why, "too few samples");
}

}  // namespace
}  // namespace estimator::structures
