// The quick look and the fit that follows it, on servos of which the answer is known.
#include "estimator/greybox/selection/screening.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {

namespace {

using diagnose_test::servo_context;
using diagnose_test::with_offset;

TEST(Glances, PutTheHiddenEffectFirstAndSayWhatItWillBring) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.06)});
  const ModelStage stage = first_stage(context);
  const std::vector<ScreeningResult> screened =
      screen(context, stage, context.problem.candidate_effects);
  ASSERT_EQ(screened.size(), context.problem.candidate_effects.size());
  const ScreeningResult& first = screened.front();
  EXPECT_EQ(first.effect, "null_bias");
  // what the look expects of the squares, the fit brings
  const RefinedCandidate trial = refine(context, first, {});
  EXPECT_NEAR(first.expected_ratio, trial.fitted.training_rms_m / stage.fitted.training_rms_m,
              0.02);
  EXPECT_NEAR(trial.fitted.value("null_bias.offset_V"), 0.06, 3e-4);
  EXPECT_LT(trial.fitted.validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
}

TEST(Glances, BeginTheFitOnTheSideOfTheTruth) {
  const SearchContext context = servo_context({.rate_mps = with_offset(-0.06)});
  const ModelStage stage = first_stage(context);
  const ScreeningResult look = screen(context, stage, context.problem.candidate_effects).front();
  const ParameterSubset& start = look.starts.front();
  ASSERT_EQ(start.parameters.back().name, "null_bias.offset_V");
  const double start_V = start.parameters.back().to_physical(start.start.tail(1)[0]);
  EXPECT_LT(start_V, 0.0);
  EXPECT_NEAR(refine(context, look, {}).fitted.value("null_bias.offset_V"), -0.06, 3e-4);
}

TEST(Glances, ExpectNothingOfAnyEffectOnAHealthyRecord) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.0)});
  for (const ScreeningResult& look :
       screen(context, first_stage(context), context.problem.candidate_effects)) {
    EXPECT_GT(look.expected_ratio, 0.99) << look.effect;
    EXPECT_LE(look.expected_ratio, 1.0) << look.effect;
  }
}

TEST(Glances, FindALongWaveOfTheSensorBySizeLengthAndPhase) {
  constexpr double kTurn = 6.283185307179586;
  const SearchContext context =
      servo_context({.rate_mps = with_offset(0.0), .reading_m = [](double y_m, double) {
                       return y_m + 4e-5 * std::sin(kTurn * y_m / 0.031 + 1.0);
                     }});
  const ScreeningResult look =
      screen(context, first_stage(context), context.problem.candidate_effects).front();
  ASSERT_EQ(look.effect, "encoder_eccentricity");
  const greybox::FitSummary fitted = refine(context, look, {}).fitted;
  EXPECT_NEAR(fitted.value("encoder_eccentricity.amplitude_m"), 4e-5, 0.02 * 4e-5);
  EXPECT_NEAR(fitted.value("encoder_eccentricity.wavelength_m"), 0.031, 0.005 * 0.031);
  EXPECT_LT(fitted.validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
}

TEST(Glances, TellOfEachEffectOnceAndStopWhenCancelled) {
  SearchContext context = servo_context({.rate_mps = with_offset(0.0), .samples = 1000});
  context.options.threads = 1;
  const ModelStage stage = first_stage(context);
  std::vector<std::string> on_screened;
  static_cast<void>(screen(context, stage, context.problem.candidate_effects,
                           [&](const std::string& effect) { on_screened.push_back(effect); }));
  EXPECT_EQ(on_screened.size(), context.problem.candidate_effects.size());
  context.options.cancel = [] { return true; };
  EXPECT_TRUE(screen(context, stage, context.problem.candidate_effects).empty());
}

}  // namespace
}  // namespace estimator::greybox::selection
