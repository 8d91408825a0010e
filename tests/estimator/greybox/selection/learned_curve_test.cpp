// A law that no formula of the dictionary has is learned as a curve.
#include "estimator/greybox/selection/learned_curve.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <optional>

#include "estimator/greybox/law_curve.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/settled_memo.h"
#include "plant_sim/library.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using diagnose_test::with_offset;
using testing::SizeIs;
using testing::StartsWith;
using testing::UnorderedElementsAre;

/// One per cent of the fastest speed: what a curve of a dozen points leaves.
constexpr double kClose_mps = 1e-3;

/// A gain that goes up and down with the command: no formula of the dictionary.
double waved_V(double u_V) { return u_V + 0.25 * std::sin(2.5 * u_V); }

TEST(LearnedCurve, ALawOfNoFormulaStaysACurve) {
  const SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double, double) { return kServoGain * waved_V(u_V); },
       .samples = 2400});
  const std::optional<LawSearch> found = search_curve(context, first_stage(context));
  ASSERT_TRUE(found);
  ASSERT_THAT(found->laws, SizeIs(1));
  const plant_sim::formula::FormulaEffect& effect = found->laws.front().effect;
  ASSERT_TRUE(effect.curve);
  EXPECT_EQ(effect.site, "opening");
  EXPECT_EQ(effect.curve->over, "x_m");
  // gain and curve together are the true law where the command goes
  plant_sim::ModelFile better =
      with_values(found->context.problem.model, found->innovations.final.model.fitted);
  const double gain = *better.value("gain_mps_per_V");
  const LawCurve curve =
      law_curve(better, context.problem.data, effect.name, "u",
                Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect.parameters.size())), {});
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double x_mps = curve.x[i];
    if (curve.share[i] < 0.005) continue;
    EXPECT_NEAR(x_mps + curve.f[i], kServoGain * waved_V(x_mps / gain), kClose_mps);
  }
}

TEST(LearnedCurve, WhatIsMissingBesideItIsFoundToo) {
  const double amplitude_m = 3e-4;
  const double turns_per_m = 2.0 * M_PI / 0.025;
  const SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double, double) { return kServoGain * waved_V(u_V); },
       .reading_m = [&](double y_m,
                        double) { return y_m + amplitude_m * std::sin(turns_per_m * y_m); },
       .samples = 2400});
  const std::optional<LawSearch> found = search_curve(context, first_stage(context));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->innovations.final.model.added,
              UnorderedElementsAre(StartsWith("opening_over_x"), "encoder_eccentricity"));
  EXPECT_THAT(found->laws, SizeIs(1));
  const FitSummary& fitted = found->innovations.final.model.fitted;
  EXPECT_NEAR(fitted.value("encoder_eccentricity.amplitude_m"), amplitude_m, 0.02 * amplitude_m);
}

TEST(LearnedCurve, NoneIsFollowedWhereAnotherModelExplainsFarMore) {
  SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double, double) { return kServoGain * waved_V(u_V); },
       .samples = 2400});
  const ModelStage first = first_stage(context);
  context.memo = std::make_shared<SettledMemo>();
  ASSERT_TRUE(search_curve(context, first));
  InnovationStage other = settled(context, first, {}, Settling::fully, wide(2));
  const double gained = penalised(other) - context.memo->least_minus_two_log(context);
  other.minus_two_log -= 3.0 * gained;
  context.memo->keep(context, "another", other);
  EXPECT_FALSE(search_curve(context, first));
}

TEST(LearnedCurve, NoneIsFoundWhereNothingIsMissing) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.0)});
  EXPECT_FALSE(search_curve(context, first_stage(context)));
}

}  // namespace
}  // namespace estimator::greybox::selection
