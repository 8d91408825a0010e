#include "estimator/structures/prediction_error.h"

#include <gmock/gmock.h>

#include <cmath>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "tests/estimator/structures/data.h"
#include "tests/estimator/structures/reference/numbers.h"

namespace estimator::structures {
namespace {

using namespace testing_data;

// Two minimisers of one criterion, both stopped near 1e-9 of the cost: differences are far below a
// standard error.
constexpr double kShare = 2e-3;

template <std::size_t kSize>
void expect_reference(const PolynomialFit& fit, const double (&value)[kSize],
                      const double* std_error, double rms) {
  ASSERT_TRUE(fit.valid) << fit.why;
  for (std::size_t i = 0; i < fit.value.size(); ++i) {
    EXPECT_NEAR(fit.value[i], value[i], kShare * std_error[i]) << fit.orders.names()[i];
    EXPECT_NEAR(fit.std_error[i], std_error[i], 0.01 * std_error[i]) << fit.orders.names()[i];
  }
  EXPECT_NEAR(fit.residual_rms_m, rms, 1e-6 * rms);
}

TEST(PredictionError, OfArmaxIsThatOfSciPy) {
  const Record record = armax_record();
  const PolynomialFit fit = fit_prediction_error({.a = 2, .b = 2, .c = 2}, record.all());
  expect_reference(fit, reference::kArmax, reference::kArmaxStdError, reference::kArmaxRms[0]);
}

TEST(PredictionError, OfBoxJenkinsIsThatOfSciPy) {
  const Record record = box_jenkins_record();
  const PolynomialFit fit = fit_prediction_error({.b = 2, .c = 1, .d = 1, .f = 2}, record.all());
  expect_reference(fit, reference::kBoxJenkins, reference::kBoxJenkinsStdError,
                   reference::kBoxJenkinsRms[0]);
}

TEST(PredictionError, OfOutputErrorIsThatOfSciPyWithItsErrorsWidenedForTheColour) {
  const Record record = box_jenkins_record();
  const PolynomialFit fit = fit_prediction_error({.b = 2, .f = 2}, record.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(fit.value[i], reference::kOutputError[i],
                kShare * reference::kOutputErrorStdError[i]);
  }
  EXPECT_NEAR(fit.residual_rms_m, reference::kOutputErrorRms[0], 1e-6);
}

TEST(PredictionError, OfArxIsLeastSquaresAndThatOfOctave) {
  const Record record = armax_record();
  const PolynomialFit fit = fit_prediction_error({.a = 2, .b = 2}, record.all());
  const Estimate batch = fit_batch({2, 2, 1, false}, record.u_V, record.y_m);
  ASSERT_TRUE(fit.valid) << fit.why;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(fit.value[i], batch.value[i], 1e-6 * batch.std_error[i]);
    EXPECT_NEAR(fit.std_error[i], batch.std_error[i], 1e-4 * batch.std_error[i]);
    // Octave starts one row earlier or later.
    EXPECT_NEAR(fit.value[i], reference::kOctaveArx[i], 0.1 * batch.std_error[i]);
  }
  EXPECT_NEAR(fit.condition, batch.condition, 1e-4 * batch.condition);
}

struct Known {
  const char* name;
  Orders orders;
  Polynomial truth;
};

class Honest : public testing::TestWithParam<Known> {};

TEST_P(Honest, StandardErrorsCoverTheTruth) {
  // 60 records: the mean square of z has a standard deviation of sqrt(2/60) = 0.18.
  constexpr int kRecords = 60;
  const Known& known = GetParam();
  const std::vector<double> truth = to_values(known.truth, known.orders.constant);
  std::vector<double> sum(truth.size(), 0.0), square(truth.size(), 0.0);
  for (int i = 0; i < kRecords; ++i) {
    const Record record = random_record(known.truth, 800, 0.2, 100 + i);
    const PolynomialFit fit = fit_prediction_error(known.orders, record.all());
    ASSERT_TRUE(fit.valid) << fit.why;
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double z = (fit.value[j] - truth[j]) / fit.std_error[j];
      sum[j] += z / kRecords;
      square[j] += z * z / kRecords;
    }
  }
  for (std::size_t j = 0; j < truth.size(); ++j) {
    EXPECT_NEAR(sum[j], 0.0, 4.0 / std::sqrt(kRecords) + 0.1) << known.orders.names()[j];
    EXPECT_NEAR(square[j], 1.0, 4.0 * 0.18 + 0.1) << known.orders.names()[j];
  }
}

INSTANTIATE_TEST_SUITE_P(
    PredictionError, Honest,
    testing::Values(
        Known{"armax",
              {.a = 2, .b = 1, .c = 1, .constant = true},
              {.a = {-1.5, 0.7}, .b = {1.0}, .c = {0.6}, .d = {}, .f = {}, .constant_m = 0.3}},
        Known{"output_error",
              {.b = 1, .f = 2, .constant = true},
              {.a = {}, .b = {1.0}, .c = {}, .d = {}, .f = {-1.5, 0.7}, .constant_m = 0.3}},
        Known{"box_jenkins",
              {.b = 1, .c = 1, .d = 1, .f = 1},
              {.a = {}, .b = {1.0}, .c = {0.5}, .d = {-0.9}, .f = {-0.8}}}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(PredictionError, OfOutputErrorFindsAnIntegratingRodAndItsDrift) {
  // F has a root at 1; the rod starts anywhere.
  const Polynomial truth{
      .a = {}, .b = {2e-4}, .c = {}, .d = {}, .f = {-1.6, 0.6}, .constant_m = 1e-6};
  Record record = random_record(truth, 3000, 5e-6, 3);
  for (double& y : record.y_m) y += 0.305;
  const PolynomialFit fit = fit_prediction_error({.b = 1, .f = 2, .constant = true}, record.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  EXPECT_NEAR(fit.residual_rms_m, 5e-6, 0.3e-6);
  EXPECT_NEAR(fit.value[0], 2e-4, 4.0 * fit.std_error[0]);
  EXPECT_LT(fit.std_error[0], 1e-6);
  EXPECT_NEAR(largest_root(fit.model.f), 1.0, 1e-4);
  const Fit free = compare(record.y_m, free_run(fit.model, record.all()[0]), 2);
  EXPECT_LT(free.rms_m, 1e-3);
}

TEST(PredictionError, JoinsStretchesAcrossGaps) {
  Record record = armax_record();
  for (std::size_t t = 700; t < 720; ++t) record.y_m[t] = NAN;
  const std::vector<std::size_t> gaps{300};
  const Stretches data = stretches_of(record.u_V, record.y_m, gaps, 0, kCount, 20);
  ASSERT_EQ(data.size(), 3u);
  EXPECT_EQ(data[0].size() + data[1].size() + data[2].size(), kCount - 20);
  const PolynomialFit fit = fit_prediction_error({.a = 2, .b = 2, .c = 2}, data);
  ASSERT_TRUE(fit.valid) << fit.why;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(fit.value[i], reference::kArmax[i], reference::kArmaxStdError[i]);
  }
}

TEST(PredictionError, SaysWhyThereIsNoFit) {
  const std::vector<double> few(12, 1.0);
  EXPECT_EQ(fit_prediction_error({.a = 2, .b = 2, .c = 2}, {{few, few}}).why, "too few samples");
  const std::vector<double> zero(500, 0.0);
  EXPECT_EQ(fit_prediction_error({.a = 2, .b = 2}, {{zero, zero}}).why, "the input is zero");
}

TEST(PolynomialOrders, ReadsAndWritesNames) {
  for (const char* name :
       {"arx211", "armax2121", "oe121", "bj11221", "armax(10,1,2,1)", "poly(1,1,0,0,1,1)"}) {
    EXPECT_EQ(parse_orders(name, false).text(), name);
  }
  EXPECT_THAT((Orders{.a = 1, .b = 1, .c = 1, .constant = true}.names()),
              testing::ElementsAre("a1", "b1", "c1", "constant"));
  for (const char* bad :
       {"arx21", "armax211", "oe", "xyz111", "arx(2,1", "oe001", "bj(1,2,3,4,99)"}) {
    EXPECT_THROW(static_cast<void>(parse_orders(bad, false)), config::schema::Error) << bad;
  }
}

TEST(PolynomialModel, HasTheLargestRootOfItsFactors) {
  EXPECT_NEAR(largest_root({-1.4, 0.45}), 0.9, 1e-12);  // (q - 0.9)(q - 0.5)
  EXPECT_EQ(largest_root({}), 0.0);
}

}  // namespace
}  // namespace estimator::structures
