// The search as a whole on servos with nothing, one and two effects hidden: what is taken, what is
// dropped, what is supported, and in which order it is told.
#include "estimator/greybox/selection/structure_search.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>

#include "estimator/greybox/selection/backward_elimination.h"
#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/indistinguishable_models.h"
#include "estimator/greybox/selection/selection_path.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {

namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using diagnose_test::stage_with;
using diagnose_test::with_offset;
using diagnose_test::with_offset_and_band;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(StructureSearch, TakesNothingOnAHealthyRecordWhoseGainIsOff) {
  const SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double, double) { return 1.02 * kServoGain * u_V; }});
  const StructureSearch search =
      selection::complete_search(context, selection::start_search(context));
  EXPECT_THAT(search.final.added, IsEmpty());
  EXPECT_EQ(search.path.size(), 1U);
  EXPECT_GT(search.nominal_rms_m, 3.0 * context.problem.data.noise_floor_m);
  EXPECT_LT(search.final.fitted.validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
  EXPECT_NEAR(search.final.fitted.value("gain_mps_per_V"), 1.02 * kServoGain, 1e-5);
}

// A gain of 5 % on both halves of the data, of which the held-out ones do not exclude chance.
TEST(StructureSearch, TakesAGainOfItsFitOnlyWhereNoiseDoesNotExplainTheStage) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.06)});
  ModelStage stage = fit_as_given(context).first;
  Candidate candidate;
  candidate.effects = {"null_bias"};
  candidate.fitted = stage.fitted;
  candidate.fitted_at_all = true;
  const auto leave = [&](double floors) {
    const double left_m = floors * context.problem.data.noise_floor_m;
    stage.fitted.training_rms_m = stage.fitted.validation_rms_m = left_m;
    stage.fitted.residual_m.setConstant(left_m);
    candidate.fitted.training_rms_m = candidate.validation_rms_m = 0.95 * left_m;
  };
  candidate.p_value = 0.1;
  for (const double floors : {1.0, 3.0}) {
    leave(floors);
    EXPECT_EQ(is_gain(context, stage, candidate), floors > 1.0) << floors;
  }
  candidate.p_value = 0.001;
  leave(1.0);
  EXPECT_TRUE(is_gain(context, stage, candidate));
}

// At the noise, with the plant at a bound of its prior, 3 standard deviations off at a cost of 9
// each.
TEST(StructureSearch, TakesAnEffectThatBringsThePlantBackFromItsBounds) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.0)});
  ModelStage stage = fit_as_given(context).first;
  const double floor_m = context.problem.data.noise_floor_m;
  stage.fitted.residual_m.setConstant(floor_m);
  stage.fitted.validation_rms_m = floor_m;
  Candidate candidate;
  candidate.effects = {"null_bias"};
  candidate.fitted = stage.fitted;
  candidate.fitted_at_all = true;
  candidate.validation_rms_m = 0.999 * floor_m;
  const FreeParameter& p = stage.fitted.parameters.front();
  stage.fitted.theta[0] = p.prior_mean + 4.0 * p.prior_sd;
  candidate.fitted.theta[0] = p.prior_mean;
  stage.fitted.at_bound.assign(stage.fitted.parameters.size(), 0);
  candidate.fitted.at_bound = stage.fitted.at_bound;
  EXPECT_FALSE(is_gain(context, stage, candidate)) << "within its bounds";
  stage.fitted.at_bound[0] = 1;
  EXPECT_TRUE(is_gain(context, stage, candidate));
  Candidate other = candidate;
  other.fitted.at_bound[0] = -1;
  EXPECT_FALSE(is_gain(context, stage, other)) << "still at a bound";
  other = candidate;
  other.fitted.theta = stage.fitted.theta;
  EXPECT_FALSE(is_gain(context, stage, other)) << "as far off";
  other = candidate;
  other.validation_rms_m = 1.001 * floor_m;
  EXPECT_FALSE(is_gain(context, stage, other)) << "leaves more";
  stage.fitted.validation_rms_m = 1.2 * floor_m;
  candidate.validation_rms_m = 1.199 * floor_m;
  EXPECT_FALSE(is_gain(context, stage, candidate)) << "noise does not explain the stage";
}

TEST(StructureSearch, FindsTwoEffectsOneAfterTheOther) {
  const SearchContext context = servo_context({.rate_mps = with_offset_and_band(0.06, 0.1)});
  const StructureSearch search =
      selection::complete_search(context, selection::start_search(context));
  EXPECT_THAT(search.final.added, UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_NEAR(search.final.fitted.value("null_bias.offset_V"), 0.06, 0.02 * 0.06);
  EXPECT_NEAR(search.final.fitted.value("deadband.half_width_V"), 0.1, 0.02 * 0.1);
  EXPECT_LT(search.final.fitted.validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
  ASSERT_EQ(search.path.size(), 3U);
  EXPECT_GT(search.path[0].fitted.validation_rms_m, search.path[1].fitted.validation_rms_m);
  EXPECT_GT(search.path[1].fitted.validation_rms_m, search.path[2].fitted.validation_rms_m);
  EXPECT_FALSE(search.interrupted);
}

// Beside a disturbance the likelihood finds what simulations do not; they ask for a second effect
// when that has failed.
TEST(StructureSearch, LeavesASecondEffectForLaterWhereNoneComesNearTheNoise) {
  // the second effect helps, and far more than it can explain remains
  const SearchContext context = servo_context({.rate_mps = [](double u_V, double y_m, double t_s) {
    return with_offset_and_band(0.06, 0.1)(u_V, y_m, t_s) + 2e-3 * std::sin(29.0 * t_s);
  }});
  SearchStart start = start_search(context);
  EXPECT_EQ(start.branch.stage.added.size(), 1U);
  EXPECT_FALSE(start.branch.stalled);
  add_second_effect(context, start);
  EXPECT_THAT(start.branch.stage.added, UnorderedElementsAre("null_bias", "deadband"));
}

TEST(StructureSearch, EndsWithTheBestSoFarWheneverItIsCancelled) {
  SearchContext context =
      servo_context({.rate_mps = with_offset_and_band(0.06, 0.1), .samples = 2000});
  for (const int after : {0, 1, 5, 20, 60}) {
    std::atomic<int> asked = 0;
    context.options.cancel = [&] { return ++asked > after; };
    const StructureSearch search =
        selection::complete_search(context, selection::start_search(context));
    EXPECT_EQ(search.interrupted, asked > after);
    ASSERT_FALSE(search.path.empty()) << after;
    EXPECT_EQ(search.final.added, search.path.back().added) << after;
    EXPECT_EQ(search.final.fitted.theta.size(),
              static_cast<Eigen::Index>(search.final.fitted.parameters.size()))
        << after;
    EXPECT_TRUE(std::isfinite(search.final.fitted.validation_rms_m)) << after;
  }
}

TEST(StructureSearch, KeepsWhatItFoundWhenItIsCancelledLateAndSomethingIsLeft) {
  SearchContext context =
      servo_context({.rate_mps =
                         [](double u_V, double, double t_s) {
                           return kServoGain * (u_V + 0.06) + 5e-4 * std::sin(0.9 * t_s);
                         },
                     .samples = 2000});
  context.options.threads = 1;
  int asked = 0;
  context.options.cancel = [&] {
    ++asked;
    return false;
  };
  const StructureSearch whole =
      selection::complete_search(context, selection::start_search(context));
  ASSERT_GT(whole.final.fitted.validation_rms_m, kUnexplained * context.problem.data.noise_floor_m);
  ASSERT_THAT(whole.final.added, testing::Contains("null_bias"));
  const int all = asked;
  for (const double share : {0.5, 0.8, 0.95, 0.99}) {
    asked = 0;
    context.options.cancel = [&] { return ++asked > share * all; };
    const StructureSearch search =
        selection::complete_search(context, selection::start_search(context));
    EXPECT_TRUE(search.interrupted) << share;
    EXPECT_THAT(search.final.added, testing::Contains("null_bias")) << share;
  }
}

TEST(Worthwhile, IsLessWhereNoiseHidesMuchOfAnEffect) {
  SearchContext context;
  context.problem.data.noise_floor_m = 2e-6;
  EXPECT_EQ(worthwhile_at(context, 2.1e-6), kWorthwhileInNoise);
  EXPECT_EQ(worthwhile_at(context, 2.4e-6), kWorthwhile);
}

TEST(LookOver, DropsAnEffectThatBringsNothingAndKeepsTheOthers) {
  const SearchContext context = servo_context({.rate_mps = with_offset_and_band(0.06, 0.1)});
  ModelStage stage = stage_with(context, first_stage(context),
                                {{"transport_delay", 1e-4},
                                 {"null_bias", 0.05},
                                 {"flow_asymmetry", 0.001},
                                 {"deadband", 0.08}});
  CrossValidation halves(context);
  eliminate_backward(context, halves, stage, EliminationPass::final);
  EXPECT_THAT(stage.added, UnorderedElementsAre("null_bias", "deadband"));
  for (const auto& p : stage.fitted.parameters) {
    EXPECT_FALSE(belongs_to(p, "transport_delay") || belongs_to(p, "flow_asymmetry")) << p.name;
  }
  EXPECT_LT(stage.fitted.validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
}

TEST(Way, BeginsWithWhatBringsMost) {
  // the offset is worth far more than the band
  const SearchContext context = servo_context({.rate_mps = with_offset_and_band(0.2, 0.02)});
  const ModelStage first = first_stage(context);
  const ModelStage final = stage_with(context, first, {{"deadband", 0.02}, {"null_bias", 0.2}});
  const std::vector<ModelStage> way = path_to(context, first, final);
  ASSERT_EQ(way.size(), 3U);
  EXPECT_THAT(way[0].added, IsEmpty());
  EXPECT_THAT(way[1].added, ElementsAre("null_bias"));
  EXPECT_THAT(way[2].added, ElementsAre("null_bias", "deadband"));
  EXPECT_EQ(way[2].fitted.validation_rms_m, final.fitted.validation_rms_m);
}

TEST(ConcludedSearch, EndsWithTheFewestEffectsThatLeaveNoise) {
  const auto concluded = [](double offset_V, double band_V) {
    const SearchContext context =
        servo_context({.rate_mps = with_offset_and_band(offset_V, band_V)});
    SearchStart start;
    start.first = first_stage(context);
    start.branch.stage =
        stage_with(context, start.first, {{"deadband", 0.05}, {"null_bias", 0.05}});
    EXPECT_TRUE(is_explained(context, start.branch.stage));
    return conclude_search(context, start).final.added;
  };
  EXPECT_THAT(concluded(0.0, 0.0), IsEmpty());
  EXPECT_THAT(concluded(0.06, 0.0), ElementsAre("null_bias"));
  EXPECT_THAT(concluded(0.06, 0.1), UnorderedElementsAre("null_bias", "deadband"));
}

/// The flow is more when extending in the first half of 20 s and less in the second.
double turning(double u_V, double /*y_m*/, double t_s) {
  const double share = (t_s < 10.0 ? 0.02 : -0.02) * (u_V > 0.0 ? 1.0 : -1.0);
  return kServoGain * (u_V * (1.0 + share) + 0.2);
}

TEST(SupportedWay, LeavesOutWhatOneHalfOfTheRecordContradicts) {
  const SearchContext context = servo_context({.rate_mps = turning});
  const ModelStage first = first_stage(context);
  const ModelStage final =
      stage_with(context, first, {{"flow_asymmetry", 0.01}, {"null_bias", 0.2}});
  CrossValidation halves(context);
  const std::vector<ModelStage> kept =
      cross_validated_path(context, halves, path_to(context, first, final));
  EXPECT_THAT(kept.back().added, ElementsAre("null_bias"));
}

bool is_supported(const SearchContext& context, bool explained, const std::string& effect,
                  double value) {
  const ModelStage first = first_stage(context);
  const auto all = [](const auto&) { return true; };
  const ModelStage more = stage_with(context, first, {{effect, value}});
  return CrossValidation(context).holds(explained, subset(first.fitted, all),
                                        subset(more.fitted, all));
}

TEST(Support, IsGivenByEitherHalfWhereTheEffectIsInBoth) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.06)});
  EXPECT_TRUE(is_supported(context, true, "null_bias", 0.05));
  EXPECT_TRUE(is_supported(context, false, "null_bias", 0.05));
}

TEST(Support, IsRefusedWhereTheHalvesDisagree) {
  const SearchContext context = servo_context({.rate_mps = [](double u_V, double, double t_s) {
    return kServoGain * (u_V + (t_s < 10.0 ? 0.06 : -0.06));
  }});
  EXPECT_FALSE(is_supported(context, true, "null_bias", 0.05));
  EXPECT_FALSE(is_supported(context, false, "null_bias", 0.05));
}

TEST(Support, IsRefusedWhereOnlyOneHalfHasIt) {
  const SearchContext context = servo_context({.rate_mps = [](double u_V, double, double t_s) {
    return kServoGain * (u_V + (t_s < 10.0 ? 0.06 : 0.0));
  }});
  EXPECT_FALSE(is_supported(context, true, "null_bias", 0.05));
}

TEST(Support, ComesFromHeldOutRecordsWhereThereAreAny) {
  const greybox::Dataset with = diagnose_test::servo_record({.rate_mps = with_offset(0.06)});
  const greybox::Dataset again =
      diagnose_test::servo_record({.rate_mps = with_offset(0.06), .seed = 8});
  const greybox::Dataset healthy =
      diagnose_test::servo_record({.rate_mps = with_offset(0.0), .seed = 8});
  const auto context_of = [&](const greybox::Dataset& held_out) {
    return SearchContext{
        make_problem(diagnose_test::servo_model(), greybox::fit_dataset({with}, {held_out})), {}};
  };
  EXPECT_TRUE(is_supported(context_of(again), true, "null_bias", 0.05));
  EXPECT_FALSE(is_supported(context_of(healthy), true, "null_bias", 0.05));
}

// On a command of +-1 V an offset b and an asymmetry b / 1 V are the same equation.
TEST(Rivals, AreEffectsThatTheMotionCannotTellApart) {
  const SearchContext context =
      servo_context({.rate_mps = with_offset(0.06), .command_V = [](double level, double y_m) {
                       return level - 20.0 * (y_m - 0.3) > 0.0 ? 1.0 : -1.0;
                     }});
  const StructureSearch search =
      selection::complete_search(context, selection::start_search(context));
  const std::vector<IndistinguishableModels> found =
      find_indistinguishable(context, search.rounds, search.final);
  ASSERT_EQ(found.size(), 1U);
  std::vector<std::string> group = found[0].others;
  group.push_back(found[0].found);
  EXPECT_THAT(group, UnorderedElementsAre("null_bias", "flow_asymmetry"));
  EXPECT_EQ(found[0].explanations.size(), 2U);
}

TEST(Rivals, AreNoneOnAMotionThatTells) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.06)});
  const StructureSearch search =
      selection::complete_search(context, selection::start_search(context));
  EXPECT_THAT(find_indistinguishable(context, search.rounds, search.final), IsEmpty());
}

}  // namespace
}  // namespace estimator::greybox::selection
