// When noise explains a record: what happens once may lie in samples that are fitted alone.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "estimator/greybox/selection/cross_validation.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kFloor_m = 2e-6;

/// Records of 10 s, each at its own rate, all of whose samples are fitted.
FitDataset fitted_at(const std::vector<double>& sample_times_s, double length_s = 10.0) {
  FitDataset data;
  std::size_t size = 0;
  for (const double sample_time_s : sample_times_s) {
    Dataset& record = data.records.emplace_back();
    record.sample_time_s = sample_time_s;
    record.t_s.resize(static_cast<std::size_t>(length_s / sample_time_s + 0.5));
    data.starts.push_back(size);
    size += record.size();
  }
  data.fitted_records = data.records.size();
  data.sample_time_s = sample_times_s.front();
  data.noise_floor_m = kFloor_m;
  data.training_mask = data.all_mask = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  return data;
}

/// A stage that leaves the noise, and `event_m` from `from_s` to `to_s` of the last record.
ModelStage with_event(const FitDataset& data, double from_s, double to_s, double event_m) {
  ModelStage stage;
  stage.fitted.validation_rms_m = kFloor_m;
  stage.fitted.residual_m = Eigen::VectorXd::Constant(data.size(), kFloor_m);
  const double sample_time_s = data.records.back().sample_time_s;
  const auto at = [&](double t_s) {
    return static_cast<Eigen::Index>(static_cast<double>(data.starts.back()) + t_s / sample_time_s +
                                     0.5);
  };
  stage.fitted.residual_m.segment(at(from_s), at(to_s) - at(from_s)).setConstant(event_m);
  return stage;
}

bool explains(const FitDataset& data, const ModelStage& stage) {
  SearchContext context;
  context.problem.data = data;
  return is_explained(context, stage);
}

TEST(ExplainedRecord, HasNoMoreThanNoiseInSamplesThatScore) {
  const FitDataset data = fitted_at({0.005});
  ModelStage stage = with_event(data, 5.0, 5.0, 0.0);
  stage.fitted.validation_rms_m = 1.14 * kFloor_m;
  EXPECT_TRUE(explains(data, stage));
  stage.fitted.validation_rms_m = 1.16 * kFloor_m;
  EXPECT_FALSE(explains(data, stage));
}

// Over the 8 s that count, 1 s of a and 7 s of the noise are hypot(a, sqrt(7)) / sqrt(8) of it.
TEST(ExplainedRecord, HasLittleMoreThanNoiseInSamplesThatAreFitted) {
  const FitDataset data = fitted_at({0.005});
  EXPECT_NEAR(fitted_rms_m(data, with_event(data, 5.0, 6.0, 3.0 * kFloor_m).fitted),
              std::sqrt((9.0 + 7.0) / 8.0) * kFloor_m, 1e-9 * kFloor_m);
  EXPECT_TRUE(explains(data, with_event(data, 5.0, 6.0, 3.0 * kFloor_m)));
  EXPECT_FALSE(explains(data, with_event(data, 5.0, 6.0, 4.0 * kFloor_m)));
}

TEST(ExplainedRecord, MayBeginElsewhereThanTheModel) {
  const FitDataset data = fitted_at({0.02, 0.005});
  EXPECT_TRUE(explains(data, with_event(data, 0.0, 2.0, 100.0 * kFloor_m)));
  EXPECT_FALSE(explains(data, with_event(data, 2.0, 2.5, 100.0 * kFloor_m)));
}

TEST(ExplainedRecord, OfTwoSecondsIsJudgedByWhatScoresAlone) {
  const FitDataset data = fitted_at({0.005}, 2.0);
  EXPECT_TRUE(explains(data, with_event(data, 1.0, 2.0, 100.0 * kFloor_m)));
}

TEST(ExplainedRecord, IsJudgedByOtherRecordsWhereTheseAreHeldOut) {
  FitDataset data = fitted_at({0.005, 0.005});
  data.fitted_records = 1;
  EXPECT_TRUE(explains(data, with_event(data, 5.0, 6.0, 100.0 * kFloor_m)));
}

}  // namespace
}  // namespace estimator::greybox::selection
