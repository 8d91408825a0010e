// Changes of what the library has no effect for: the scale of the position sensor, which a record
// shows only where it drifts, and formulas that the model file declares.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/change_scores.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::Reading;
using diagnose_test::servo_context;
using testing::IsEmpty;
using testing::SizeIs;

Diagnosis diagnosed(const SearchContext& context) {
  return diagnose(context.problem, context.options);
}

SearchContext read_by(const Reading& reading_m) {
  return servo_context({.rate_mps = [](double u_V, double, double) { return kServoGain * u_V; },
                        .reading_m = reading_m});
}

void expect_drift(const Diagnosis& d, double to) {
  EXPECT_EQ(d.verdict, Verdict::changing);
  EXPECT_THAT(d.missing, IsEmpty());
  ASSERT_THAT(d.changing, SizeIs(1));
  const ParameterChange& change = d.changing.front();
  EXPECT_EQ(change.parameter, "reading_scale.scale_ratio");
  EXPECT_EQ(change.kind, ChangeKind::ramp);
  EXPECT_EQ(change.from, 0.0);
  EXPECT_NEAR(change.to, to, 4.0 * change.to_error);
  EXPECT_LT(change.to_error, 0.1 * std::abs(to));
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
}

TEST(SensorScale, ThatDriftsIsNoPlantThatDoes) {
  expect_drift(diagnosed(read_by(
                   [](double y_m, double t_s) { return y_m + 0.01 * t_s / 20.0 * (y_m - 0.3); })),
               0.01);
}

TEST(SensorScale, DriftsAboutTheSensorsOwnZero) {
  expect_drift(
      diagnosed(read_by([](double y_m, double t_s) { return y_m * (1.0 + 0.01 * t_s / 20.0); })),
      0.01);
}

TEST(SensorScale, DriftsOnAnActuatorAsWell) {
  const SearchContext context = diagnose_test::context_of(
      "motion=fast_steps,left_out=scale_drift,left_out.size=-0.006,left_out.where=-0.305", 5);
  expect_drift(diagnosed(context), -0.006);
}

TEST(DeclaredFormula, IsNotTakenForOneThatIsNothingBeforeItChanges) {
  SearchContext context = read_by(diagnose_test::plain_reading);
  plant_sim::formula::FormulaEffect pull;
  pull.name = "pull";
  pull.site = "opening";
  pull.formula = "x_m - rate_per_s * (y_m - 0.3)";
  pull.what = "pull to the middle";
  pull.parameters = {{"rate_per_s", "rate", -10.0, 10.0, 0.1, 0.0}};
  plant_sim::ModelFile model = context.problem.model;
  model.declare(pull, "test");
  context.problem = make_problem(model, context.problem.data);
  const InnovationStage stage = settled(context, first_stage(context), {}, Settling::once, {});
  const std::vector<ChangeScore> scores = change_scores(stage);
  const auto is_pull = [](const ChangeScore& one) {
    return one.parameter.name == "pull.rate_per_s";
  };
  EXPECT_TRUE(std::any_of(scores.begin(), scores.end(), is_pull));
  for (const ChangeScore& score : scores) EXPECT_FALSE(score.zero_before) << score.parameter.name;
}

}  // namespace
}  // namespace estimator::greybox::selection
