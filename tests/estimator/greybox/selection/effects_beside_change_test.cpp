// An effect and a change in time that hide one another are told apart.
#include "estimator/greybox/selection/effects_beside_change.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using testing::ElementsAre;

/// A gain that grows by a quarter at 12 s, after a dead band and an offset of the command.
SearchContext growing_servo(double dead_band_V, double offset_V) {
  return servo_context({.rate_mps = [=](double u_V, double, double t_s) {
    const double open_V = u_V + offset_V;
    const double past_V = std::max(0.0, std::abs(open_V) - dead_band_V);
    return kServoGain * (t_s < 12.0 ? 1.0 : 1.25) * std::copysign(past_V, open_V);
  }});
}

TEST(EffectsBesideChange, AreThoseThatTheChangeLeaves) {
  const SearchContext context = growing_servo(0.02, 0.0);
  const ModelStage first = first_stage(context);
  const FoundChanges changes = search_changes(context, first);
  EXPECT_FALSE(changes.explaining.has_value());
  ASSERT_TRUE(changes.likeliest.has_value());
  const std::optional<ModelStage> beside = effects_beside(first, *changes.likeliest);
  ASSERT_TRUE(beside.has_value());
  EXPECT_THAT(beside->added, ElementsAre("deadband"));
  EXPECT_NEAR(beside->fitted.value("deadband.half_width_V"), 0.02, 1e-3);
  for (const FreeParameter& p : beside->fitted.parameters) {
    EXPECT_FALSE(p.name.starts_with("change.")) << p.name;
  }
  const FoundChanges again = search_changes(context, *beside);
  ASSERT_TRUE(again.explaining.has_value());
  EXPECT_EQ(again.explaining->changes.front().parameter, "gain_mps_per_V");
  EXPECT_NEAR(again.explaining->changes.front().to, 1.25 * kServoGain, 1e-3 * kServoGain);
}

TEST(EffectsBesideChange, AreNoneWhereTheChangeLeavesNothing) {
  const SearchContext context = growing_servo(0.0, 0.0);
  const ModelStage first = first_stage(context);
  const FoundChanges changes = search_changes(context, first);
  ASSERT_TRUE(changes.explaining.has_value());
  EXPECT_FALSE(effects_beside(first, *changes.explaining).has_value());
  EXPECT_FALSE(steady_effect(first, *changes.explaining).has_value());
}

TEST(EffectsBesideChange, AnEffectThatHardlyChangesIsSteady) {
  const SearchContext context = growing_servo(0.0, 0.3);
  const ModelStage first = first_stage(context);
  ChangeSearch search = search_changes(context, first).explaining.value();
  const auto offset = std::find_if(
      search.changes.begin(), search.changes.end(),
      [](const ParameterChange& one) { return one.parameter == "null_bias.offset_V"; });
  ASSERT_NE(offset, search.changes.end());
  offset->from = 0.3;
  offset->to = 0.29;
  const std::optional<ModelStage> steady = steady_effect(first, search);
  ASSERT_TRUE(steady.has_value());
  EXPECT_THAT(steady->added, ElementsAre("null_bias"));
  offset->to = 0.2;
  EXPECT_FALSE(steady_effect(first, search).has_value());
}

}  // namespace
}  // namespace estimator::greybox::selection
