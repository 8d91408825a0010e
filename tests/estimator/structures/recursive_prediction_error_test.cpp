#include "estimator/structures/recursive_prediction_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/structures/prediction_error.h"
#include "tests/count_allocations.h"
#include "tests/estimator/structures/data.h"

namespace estimator::structures {
namespace {

using namespace testing_data;

struct Case {
  const char* name;
  Orders orders;
  Polynomial truth;
  bool extended;
};

class OnLine : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    RecursivePredictionError, OnLine,
    testing::Values(
        Case{"arx",
             {.a = 2, .b = 1, .constant = true},
             {.a = {-1.5, 0.7}, .b = {1.0}, .c = {}, .d = {}, .f = {}, .constant_m = 0.3},
             false},
        Case{"armax",
             {.a = 2, .b = 1, .c = 1},
             {.a = {-1.5, 0.7}, .b = {1.0}, .c = {0.6}, .d = {}, .f = {}},
             false},
        Case{"extended",
             {.a = 2, .b = 1, .c = 1},
             {.a = {-1.5, 0.7}, .b = {1.0}, .c = {0.6}, .d = {}, .f = {}},
             true},
        Case{"output_error",
             {.b = 1, .f = 2},
             {.a = {}, .b = {1.0}, .c = {}, .d = {}, .f = {-1.5, 0.7}},
             false},
        Case{"box_jenkins",
             {.b = 1, .c = 1, .d = 1, .f = 1},
             {.a = {}, .b = {1.0}, .c = {0.5}, .d = {-0.9}, .f = {-0.8}},
             false}),
    [](const auto& of) { return std::string(of.param.name); });

RecursivePredictionError run(const Case& of, const Record& record) {
  RecursivePredictionError out({.orders = of.orders, .extended = of.extended});
  for (std::size_t t = 0; t < record.u_V.size(); ++t) out.push(record.u_V[t], record.y_m[t]);
  return out;
}

TEST_P(OnLine, EndsWhereTheBatchFitEnds) {
  const Record record = random_record(GetParam().truth, 20000, 0.2, 1);
  const RecursivePredictionError filter = run(GetParam(), record);
  const PolynomialFit batch = fit_prediction_error(GetParam().orders, record.all());
  std::array<double, kMaxCoefficients> errors{};
  filter.std_error(errors.data());
  for (int i = 0; i < GetParam().orders.size(); ++i) {
    // Both estimate from the same data: they differ by the transient of the first few hundred
    // samples and, for extended least squares, by its lower efficiency.
    EXPECT_NEAR(filter.value()[i], batch.value[i], 1.5 * batch.std_error[i])
        << GetParam().orders.names()[i];
    if (!GetParam().extended) {
      EXPECT_NEAR(errors[i], batch.std_error[i], 0.25 * batch.std_error[i]);
    }
  }
}

TEST_P(OnLine, CoversTheTruth) {
  constexpr int kRecords = 40;
  const std::vector<double> truth = to_values(GetParam().truth, GetParam().orders.constant);
  std::vector<double> square(truth.size(), 0.0);
  for (int i = 0; i < kRecords; ++i) {
    const RecursivePredictionError filter =
        run(GetParam(), random_record(GetParam().truth, 6000, 0.2, 200 + i));
    std::array<double, kMaxCoefficients> errors{};
    filter.std_error(errors.data());
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double z = (filter.value()[j] - truth[j]) / errors[j];
      square[j] += z * z / kRecords;
    }
  }
  // Standard deviation of the mean square: 0.22. The start's transient and, extended, the missing
  // filter widen the true scatter.
  for (const double mean : square) {
    EXPECT_GT(mean, 0.3);
    EXPECT_LT(mean, GetParam().extended ? 4.0 : 2.2);
  }
}

TEST_P(OnLine, FollowsAChangeWithForgetting) {
  RecursivePredictionError filter(
      {.orders = GetParam().orders, .extended = GetParam().extended, .forgetting = 0.995});
  Polynomial after = GetParam().truth;
  after.b[0] = 1.25;
  const Record first = random_record(GetParam().truth, 4000, 0.2, 3);
  const Record second = random_record(after, 4000, 0.2, 4);
  for (const Record* record : {&first, &second}) {
    for (std::size_t t = 0; t < 4000; ++t) filter.push(record->u_V[t], record->y_m[t]);
    filter.gap();
  }
  const int b = GetParam().orders.a;
  std::array<double, kMaxCoefficients> errors{};
  filter.std_error(errors.data());
  EXPECT_NEAR(filter.value()[b], 1.25, 4.0 * errors[b]);
  EXPECT_LT(errors[b], 0.06);  // 0.2 / sqrt(2 / 0.005 samples) = 0.01 at least
}

TEST_P(OnLine, NeverAllocatesAndIsCarriedBitForBit) {
  const Record record = random_record(GetParam().truth, 1000, 0.2, 9);
  RecursivePredictionError whole = run(GetParam(), Record{});
  RecursivePredictionError other({.orders = GetParam().orders, .extended = GetParam().extended});
  for (std::size_t t = 0; t < 500; ++t) whole.push(record.u_V[t], record.y_m[t]);
  std::vector<std::uint8_t> bytes;
  StateArchive out = StateArchive::saving(bytes);
  whole.serialize(out);
  StateArchive in = StateArchive::restoring(bytes);
  other.serialize(in);
  ASSERT_TRUE(in.complete());
  const long before = allocations;
  for (std::size_t t = 500; t < 1000; ++t) whole.push(record.u_V[t], record.y_m[t]);
  EXPECT_EQ(allocations, before);
  for (std::size_t t = 500; t < 1000; ++t) other.push(record.u_V[t], record.y_m[t]);
  for (int i = 0; i < GetParam().orders.size(); ++i) {
    EXPECT_EQ(whole.value()[i], other.value()[i]);
  }
}

TEST(RecursivePredictionError, KeepsItsCoefficientsOverAGapAndAMissingValue) {
  const Polynomial truth{.a = {-0.9}, .b = {1.0}, .c = {0.5}, .d = {}, .f = {}};
  const Record record = random_record(truth, 3000, 0.1, 5);
  RecursivePredictionError filter({.orders = {.a = 1, .b = 1, .c = 1}});
  for (std::size_t t = 0; t < 2000; ++t) filter.push(record.u_V[t], record.y_m[t]);
  const double b = filter.value()[1];
  EXPECT_FALSE(filter.push(1.0, NAN));
  EXPECT_EQ(filter.value()[1], b);
  for (std::size_t t = 2000; t < 3000; ++t) filter.push(record.u_V[t], record.y_m[t]);
  EXPECT_NEAR(filter.value()[1], 1.0, 0.02);
}

TEST(RecursivePredictionError, RefusesWhatItCannotDo) {
  using config::schema::Error;
  EXPECT_THROW(RecursivePredictionError({.orders = {.a = 1, .b = 1}, .forgetting = 0.0}), Error);
  EXPECT_THROW(RecursivePredictionError({.orders = {.a = 9, .b = 9, .c = 9}}), Error);
  EXPECT_THROW(RecursivePredictionError({.orders = {.b = 1, .f = 1}, .extended = true}), Error);
}

}  // namespace
}  // namespace estimator::structures
