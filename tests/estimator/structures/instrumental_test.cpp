#include "estimator/structures/instrumental.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/structures/data.h"
#include "tests/estimator/structures/reference/numbers.h"

namespace estimator::structures {
namespace {

using namespace testing_data;

const Structure kArx211{2, 1, 1, false};

BiasTest with_reference(const Record& record) {
  return test_bias(kArx211, record.all(), {record.reference_m});
}

TEST(InstrumentalVariables, AreThoseOfNumPyWithTheSameInstruments) {
  // ARX(2,2,1) has u(t-1) .. u(t-8) as instruments when u is handed over as the reference.
  const Record record = armax_record();
  const BiasTest test = test_bias({2, 2, 1, false}, record.all(), {record.u_V});
  ASSERT_EQ(test.instruments, InstrumentChoice::reference);
  ASSERT_EQ(test.instrument_count, 8);
  for (std::size_t i = 0; i < 4; ++i) {
    // The script starts one row later.
    EXPECT_NEAR(test.instrumental[i], reference::kTwoStage[i], 0.1 * test.instrumental_error[i]);
    EXPECT_NEAR(test.least_squares[i], reference::kTwoStageLeastSquares[i],
                0.1 * test.least_squares_error[i]);
  }
  EXPECT_EQ(test.dof, 2);  // the u regressors are instruments themselves
  EXPECT_NEAR(test.statistic, reference::kTwoStageStatistic[0],
              0.05 * reference::kTwoStageStatistic[0]);
}

TEST(InstrumentalVariables, FindTheTruthInClosedLoopWhereLeastSquaresDoesNot) {
  const Record record = closed_loop(20000, 1e-6, 2e-4, 1);
  const BiasTest test = with_reference(record);
  EXPECT_EQ(test.verdict, BiasVerdict::biased);
  EXPECT_LT(test.p, 1e-6);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(test.instrumental[i] - kClosedLoop[i]), 4.0 * test.instrumental_error[i]);
  }
  EXPECT_GT(std::abs(test.least_squares[0] - kClosedLoop[0]), 20.0 * test.least_squares_error[0]);
}

TEST(InstrumentalVariables, OfDelayedSamplesFindTheTruthWithoutAReference) {
  const Record record = closed_loop(40000, 1e-6, 2e-4, 2);
  const BiasTest test = test_bias(kArx211, record.all());
  EXPECT_EQ(test.instruments, InstrumentChoice::delayed);
  EXPECT_EQ(test.verdict, BiasVerdict::biased);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(test.instrumental[i] - kClosedLoop[i]), 4.0 * test.instrumental_error[i]);
  }
}

TEST(InstrumentalVariables, HaveHonestStandardErrorsUnderColouredNoise) {
  constexpr int kRecords = 200;
  double square[3] = {};
  for (int i = 0; i < kRecords; ++i) {
    const BiasTest test = with_reference(closed_loop(3000, 1e-6, 5e-5, 50 + i));
    for (std::size_t j = 0; j < 3; ++j) {
      const double z = (test.instrumental[j] - kClosedLoop[j]) / test.instrumental_error[j];
      square[j] += z * z / kRecords;
    }
  }
  // Standard deviation of the mean square: 0.1; Newey-West is some 10 % low on 3000 rows.
  for (const double mean : square) EXPECT_NEAR(mean, 1.0, 0.5);
}

TEST(DurbinWuHausman, RejectsAtItsLevelWhenLeastSquaresIsRight) {
  constexpr int kRecords = 400;
  int rejected = 0;
  for (int i = 0; i < kRecords; ++i) {
    const BiasTest test = with_reference(closed_loop(1500, 5e-5, 0.0, 1000 + i));
    EXPECT_NE(test.verdict, BiasVerdict::undetermined);
    rejected += test.p < 0.05 ? 1 : 0;
  }
  // 20 expected; binomial standard deviation 4.4.
  EXPECT_GT(rejected, 4);
  EXPECT_LT(rejected, 40);
}

TEST(DurbinWuHausman, CannotTellFromASineReference) {
  // Without noise in the loop a sine spans two directions; three coefficients need three.
  Record record;
  double x1 = 0.0, x2 = 0.0, u1 = 0.0;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int t = 0; t < 6000; ++t) {
    const double x = 1.6 * x1 - 0.6 * x2 + 2e-4 * u1;
    const double y = x + 5e-6 * normal(random);
    const double r = 0.0254 * std::sin(2.0 * 3.14159265358979 * 0.5 * 0.005 * t);
    const double u = 150.0 * (r - y);
    record.y_m.push_back(y);
    record.u_V.push_back(u);
    record.reference_m.push_back(r);
    x2 = x1;
    x1 = x;
    u1 = u;
  }
  // The first second holds the start's transient.
  const auto late = [](const std::vector<double>& x) { return std::span(x).subspan(400); };
  const BiasTest test =
      test_bias(kArx211, {{late(record.u_V), late(record.y_m)}}, {late(record.reference_m)});
  EXPECT_EQ(test.verdict, BiasVerdict::undetermined);
  EXPECT_LT(test.f_statistic, kWeakInstruments);
}

}  // namespace
}  // namespace estimator::structures
