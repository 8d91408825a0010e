// A parameter that differs between records is found with the record in which it does.
#include "estimator/greybox/selection/record_differences.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_model;
using diagnose_test::servo_record;
using testing::IsEmpty;
using testing::SizeIs;

/// Records "a", "b", ... of servos y' = 0.05 gain (u + offset).
struct Servo {
  double gain = 1.0;
  double offset_V = 0.0;
};
Diagnosis diagnosed(const std::vector<Servo>& servos) {
  std::vector<Dataset> records;
  for (const Servo& servo : servos) {
    const auto number = static_cast<unsigned>(records.size());
    records.push_back(servo_record(
        {.rate_mps = [=](double u_V, double,
                         double) { return kServoGain * servo.gain * (u_V + servo.offset_V); },
         .samples = 2400,
         .seed = 3 + number}));
    records.back().name = std::string(1, static_cast<char>('a' + number));
  }
  return diagnose(make_problem(servo_model(), fit_dataset(std::move(records), {})), {});
}

TEST(RecordDifferences, AGainThatDiffersIsNamedWithItsRecord) {
  const Diagnosis d = diagnosed({{}, {1.03}, {}});
  EXPECT_EQ(d.verdict, Verdict::changing);
  EXPECT_THAT(d.missing, IsEmpty());
  ASSERT_THAT(d.changing, SizeIs(1));
  const ParameterChange& change = d.changing.front();
  EXPECT_EQ(change.parameter, "gain_mps_per_V");
  EXPECT_EQ(change.kind, ChangeKind::record);
  EXPECT_EQ(change.record, "b");
  EXPECT_NEAR(change.from, kServoGain, 4.0 * change.from_error);
  EXPECT_NEAR(change.to, 1.03 * kServoGain, 4.0 * change.to_error);
  EXPECT_LT(change.to_error, 1e-3 * kServoGain);
  EXPECT_LT(d.rms_after_m, 1.15 * d.noise_floor_m);
}

TEST(RecordDifferences, AnOffsetOfOneRecordAloneIsNamed) {
  const Diagnosis d = diagnosed({{}, {1.0, 0.05}});
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "null_bias.offset_V");
  EXPECT_EQ(d.changing.front().record, "b");
  EXPECT_NEAR(d.changing.front().to - d.changing.front().from, 0.05, 0.002);
}

TEST(RecordDifferences, OfTwoRecordsTheOneThatIsFartherFromTheFileDiffers) {
  const Diagnosis d = diagnosed({{1.03}, {}});
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "gain_mps_per_V");
  EXPECT_EQ(d.changing.front().record, "a");
  EXPECT_NEAR(d.changing.front().from, kServoGain, 4.0 * d.changing.front().from_error);
  EXPECT_NEAR(d.changing.front().to, 1.03 * kServoGain, 4.0 * d.changing.front().to_error);
  EXPECT_LT(d.changing.front().from_error, 1e-3 * kServoGain);
}

TEST(RecordDifferences, AnOffsetOfTheFirstRecordAloneIsNamed) {
  const Diagnosis d = diagnosed({{1.0, 0.05}, {}});
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "null_bias.offset_V");
  EXPECT_EQ(d.changing.front().record, "a");
  EXPECT_EQ(d.changing.front().from, 0.0);
  EXPECT_NEAR(d.changing.front().to, 0.05, 0.002);
}

TEST(RecordDifferences, RecordsOfOneServoDoNotDiffer) {
  const Diagnosis d = diagnosed({{}, {}});
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_THAT(d.changing, IsEmpty());
}

TEST(RecordDifferences, AnEffectThatAllRecordsHaveKeepsItsName) {
  const Diagnosis d = diagnosed({{1.0, 0.05}, {1.0, 0.05}});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("null_bias"));
  EXPECT_THAT(d.changing, IsEmpty());
}

}  // namespace
}  // namespace estimator::greybox::selection
