// The search as a whole on servos with nothing, one and two effects hidden: what is taken, what is
// dropped, what is supported, and in which order it is told.
#include "estimator/greybox/selection/structure_search.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>

#include "estimator/greybox/selection/backward_elimination.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/indistinguishable_models.h"
#include "estimator/greybox/selection/selection_path.h"
#include "tests/workbench/diagnose/servo_shop.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_shop;
using diagnose_test::stage_with;
using diagnose_test::with_offset;
using diagnose_test::with_offset_and_band;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(Ladder, TakesNothingOnAHealthyRecordWhoseGainIsOff) {
  const selection::Workshop shop =
      servo_shop({.rate_mps = [](double u_V, double, double) { return 1.02 * kServoGain * u_V; }});
  const selection::Ladder ladder = selection::climb(shop);
  EXPECT_THAT(ladder.final.added, IsEmpty());
  EXPECT_EQ(ladder.way.size(), 1U);
  EXPECT_GT(ladder.nominal_rms_m, 3.0 * shop.evidence.noise_floor_m);
  EXPECT_LT(ladder.final.fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
  EXPECT_NEAR(ladder.final.fitted.value("gain_mps_per_V"), 1.02 * kServoGain, 1e-5);
}

TEST(Ladder, FindsTwoEffectsOneAfterTheOther) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset_and_band(0.06, 0.1)});
  const selection::Ladder ladder = selection::climb(shop);
  EXPECT_THAT(ladder.final.added, UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_NEAR(ladder.final.fitted.value("null_bias.offset_V"), 0.06, 0.02 * 0.06);
  EXPECT_NEAR(ladder.final.fitted.value("deadband.half_width_V"), 0.1, 0.02 * 0.1);
  EXPECT_LT(ladder.final.fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
  ASSERT_EQ(ladder.way.size(), 3U);
  EXPECT_GT(ladder.way[0].fitted.score_rms_m, ladder.way[1].fitted.score_rms_m);
  EXPECT_GT(ladder.way[1].fitted.score_rms_m, ladder.way[2].fitted.score_rms_m);
  EXPECT_FALSE(ladder.interrupted);
}

TEST(Ladder, EndsWithTheBestSoFarWheneverItIsCancelled) {
  selection::Workshop shop =
      servo_shop({.rate_mps = with_offset_and_band(0.06, 0.1), .samples = 2000});
  for (const int after : {0, 1, 5, 20, 60}) {
    std::atomic<int> asked = 0;
    shop.cancel = [&] { return ++asked > after; };
    const selection::Ladder ladder = selection::climb(shop);
    EXPECT_EQ(ladder.interrupted, asked > after);
    ASSERT_FALSE(ladder.way.empty()) << after;
    EXPECT_EQ(ladder.final.added, ladder.way.back().added) << after;
    EXPECT_EQ(ladder.final.fitted.x.size(),
              static_cast<Eigen::Index>(ladder.final.fitted.searched.size()))
        << after;
    EXPECT_TRUE(std::isfinite(ladder.final.fitted.score_rms_m)) << after;
  }
}

TEST(Ladder, KeepsWhatItFoundWhenItIsCancelledLateAndSomethingIsLeft) {
  selection::Workshop shop =
      servo_shop({.rate_mps =
                      [](double u_V, double, double t_s) {
                        return kServoGain * (u_V + 0.06) + 5e-4 * std::sin(0.9 * t_s);
                      },
                  .samples = 2000});
  shop.threads = 1;
  int asked = 0;
  shop.cancel = [&] {
    ++asked;
    return false;
  };
  const selection::Ladder whole = selection::climb(shop);
  ASSERT_GT(whole.final.fitted.score_rms_m, selection::kUnexplained * shop.evidence.noise_floor_m);
  ASSERT_THAT(whole.final.added, testing::Contains("null_bias"));
  const int all = asked;
  for (const double share : {0.5, 0.8, 0.95, 0.99}) {
    asked = 0;
    shop.cancel = [&] { return ++asked > share * all; };
    const selection::Ladder ladder = selection::climb(shop);
    EXPECT_TRUE(ladder.interrupted) << share;
    EXPECT_THAT(ladder.final.added, testing::Contains("null_bias")) << share;
  }
}

TEST(Worthwhile, IsLessWhereNoiseHidesMuchOfAnEffect) {
  selection::Workshop shop;
  shop.evidence.noise_floor_m = 2e-6;
  EXPECT_EQ(selection::worthwhile_at(shop, 2.1e-6), selection::kWorthwhileInNoise);
  EXPECT_EQ(selection::worthwhile_at(shop, 2.4e-6), selection::kWorthwhile);
}

TEST(LookOver, DropsAnEffectThatBringsNothingAndKeepsTheOthers) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset_and_band(0.06, 0.1)});
  selection::Stage stage = stage_with(shop, selection::first_stage(shop),
                                      {{"transport_delay", 1e-4},
                                       {"null_bias", 0.05},
                                       {"flow_asymmetry", 0.001},
                                       {"deadband", 0.08}});
  selection::look_over(shop, stage, selection::Look::final);
  EXPECT_THAT(stage.added, UnorderedElementsAre("null_bias", "deadband"));
  for (const auto& p : stage.fitted.searched) {
    EXPECT_FALSE(selection::belongs(p, "transport_delay") ||
                 selection::belongs(p, "flow_asymmetry"))
        << p.name;
  }
  EXPECT_LT(stage.fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
}

TEST(Way, BeginsWithWhatBringsMost) {
  // the offset is worth far more than the band
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset_and_band(0.2, 0.02)});
  const selection::Stage first = selection::first_stage(shop);
  const selection::Stage final = stage_with(shop, first, {{"deadband", 0.02}, {"null_bias", 0.2}});
  const std::vector<selection::Stage> way = selection::way_to(shop, first, final);
  ASSERT_EQ(way.size(), 3U);
  EXPECT_THAT(way[0].added, IsEmpty());
  EXPECT_THAT(way[1].added, ElementsAre("null_bias"));
  EXPECT_THAT(way[2].added, ElementsAre("null_bias", "deadband"));
  EXPECT_EQ(way[2].fitted.score_rms_m, final.fitted.score_rms_m);
}

/// The flow is more when extending in the first half of 20 s and less in the second.
double turning(double u_V, double /*y_m*/, double t_s) {
  const double share = (t_s < 10.0 ? 0.02 : -0.02) * (u_V > 0.0 ? 1.0 : -1.0);
  return kServoGain * (u_V * (1.0 + share) + 0.2);
}

TEST(SupportedWay, LeavesOutWhatOneHalfOfTheRecordContradicts) {
  const selection::Workshop shop = servo_shop({.rate_mps = turning});
  const selection::Stage first = selection::first_stage(shop);
  const selection::Stage final =
      stage_with(shop, first, {{"flow_asymmetry", 0.01}, {"null_bias", 0.2}});
  const std::vector<selection::Stage> kept =
      selection::supported_way(shop, selection::way_to(shop, first, final));
  EXPECT_THAT(kept.back().added, ElementsAre("null_bias"));
}

bool is_supported(const selection::Workshop& shop, bool explained, const std::string& effect,
                  double value) {
  const selection::Stage first = selection::first_stage(shop);
  const auto all = [](const auto&) { return true; };
  const selection::Stage more = stage_with(shop, first, {{effect, value}});
  return selection::supported(shop, explained, selection::select(first.fitted, all),
                              selection::select(more.fitted, all));
}

TEST(Support, IsGivenByEitherHalfWhereTheEffectIsInBoth) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset(0.06)});
  EXPECT_TRUE(is_supported(shop, true, "null_bias", 0.05));
  EXPECT_TRUE(is_supported(shop, false, "null_bias", 0.05));
}

TEST(Support, IsRefusedWhereTheHalvesDisagree) {
  const selection::Workshop shop = servo_shop({.rate_mps = [](double u_V, double, double t_s) {
    return kServoGain * (u_V + (t_s < 10.0 ? 0.06 : -0.06));
  }});
  EXPECT_FALSE(is_supported(shop, true, "null_bias", 0.05));
  EXPECT_FALSE(is_supported(shop, false, "null_bias", 0.05));
}

TEST(Support, IsRefusedWhereOnlyOneHalfHasIt) {
  const selection::Workshop shop = servo_shop({.rate_mps = [](double u_V, double, double t_s) {
    return kServoGain * (u_V + (t_s < 10.0 ? 0.06 : 0.0));
  }});
  EXPECT_FALSE(is_supported(shop, true, "null_bias", 0.05));
}

TEST(Support, ComesFromHeldOutRecordsWhereThereAreAny) {
  const greybox::Measured with = diagnose_test::servo_record({.rate_mps = with_offset(0.06)});
  const greybox::Measured again =
      diagnose_test::servo_record({.rate_mps = with_offset(0.06), .seed = 8});
  const greybox::Measured healthy =
      diagnose_test::servo_record({.rate_mps = with_offset(0.0), .seed = 8});
  const auto shop_of = [&](const greybox::Measured& held_out) {
    return selection::workshop(diagnose_test::servo_model(), greybox::evidence({with}, {held_out}));
  };
  EXPECT_TRUE(is_supported(shop_of(again), true, "null_bias", 0.05));
  EXPECT_FALSE(is_supported(shop_of(healthy), true, "null_bias", 0.05));
}

// On a command of +-1 V an offset b and an asymmetry b / 1 V are the same equation.
TEST(Rivals, AreEffectsThatTheMotionCannotTellApart) {
  const selection::Workshop shop =
      servo_shop({.rate_mps = with_offset(0.06), .command_V = [](double level, double y_m) {
                    return level - 20.0 * (y_m - 0.3) > 0.0 ? 1.0 : -1.0;
                  }});
  const selection::Ladder ladder = selection::climb(shop);
  const std::vector<selection::Rivalry> found =
      selection::rivalries(shop, ladder.rounds, ladder.final);
  ASSERT_EQ(found.size(), 1U);
  std::vector<std::string> group = found[0].others;
  group.push_back(found[0].found);
  EXPECT_THAT(group, UnorderedElementsAre("null_bias", "flow_asymmetry"));
  EXPECT_EQ(found[0].explanations.size(), 2U);
}

TEST(Rivals, AreNoneOnAMotionThatTells) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset(0.06)});
  const selection::Ladder ladder = selection::climb(shop);
  EXPECT_THAT(selection::rivalries(shop, ladder.rounds, ladder.final), IsEmpty());
}

}  // namespace
}  // namespace workbench::diagnose
