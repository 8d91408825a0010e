// The quick look and the fit that follows it, on servos of which the answer is known.
#include "estimator/greybox/selection/screening.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/structure_search.h"
#include "tests/workbench/diagnose/servo_shop.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::servo_shop;
using diagnose_test::with_offset;

TEST(Glances, PutTheHiddenEffectFirstAndSayWhatItWillBring) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset(0.06)});
  const selection::Stage stage = selection::first_stage(shop);
  const std::vector<selection::Glance> glances = selection::glances_at(shop, stage, shop.absent);
  ASSERT_EQ(glances.size(), shop.absent.size());
  const selection::Glance& first = glances.front();
  EXPECT_EQ(first.effect, "null_bias");
  // what the look expects of the squares, the fit brings
  const selection::Trial trial = selection::attempt(shop, first, {});
  EXPECT_NEAR(first.expected_ratio, trial.fitted.fit_rms_m / stage.fitted.fit_rms_m, 0.02);
  EXPECT_NEAR(trial.fitted.value("null_bias.offset_V"), 0.06, 3e-4);
  EXPECT_LT(trial.fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
}

TEST(Glances, BeginTheFitOnTheSideOfTheTruth) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset(-0.06)});
  const selection::Stage stage = selection::first_stage(shop);
  const selection::Glance look = selection::glances_at(shop, stage, shop.absent).front();
  ASSERT_EQ(look.searched.back().name, "null_bias.offset_V");
  const double start_V = look.searched.back().value(look.starts.front().tail(1)[0]);
  EXPECT_LT(start_V, 0.0);
  EXPECT_NEAR(selection::attempt(shop, look, {}).fitted.value("null_bias.offset_V"), -0.06, 3e-4);
}

TEST(Glances, ExpectNothingOfAnyEffectOnAHealthyRecord) {
  const selection::Workshop shop = servo_shop({.rate_mps = with_offset(0.0)});
  for (const selection::Glance& look :
       selection::glances_at(shop, selection::first_stage(shop), shop.absent)) {
    EXPECT_GT(look.expected_ratio, 0.99) << look.effect;
    EXPECT_LE(look.expected_ratio, 1.0) << look.effect;
  }
}

TEST(Glances, FindALongWaveOfTheSensorBySizeLengthAndPhase) {
  constexpr double kTurn = 6.283185307179586;
  const selection::Workshop shop =
      servo_shop({.rate_mps = with_offset(0.0), .reading_m = [](double y_m, double) {
                    return y_m + 4e-5 * std::sin(kTurn * y_m / 0.031 + 1.0);
                  }});
  const selection::Glance look =
      selection::glances_at(shop, selection::first_stage(shop), shop.absent).front();
  ASSERT_EQ(look.effect, "encoder_eccentricity");
  const greybox::Fitted fitted = selection::attempt(shop, look, {}).fitted;
  EXPECT_NEAR(fitted.value("encoder_eccentricity.amplitude_m"), 4e-5, 0.02 * 4e-5);
  EXPECT_NEAR(fitted.value("encoder_eccentricity.wavelength_m"), 0.031, 0.005 * 0.031);
  EXPECT_LT(fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
}

TEST(Glances, TellOfEachEffectOnceAndStopWhenCancelled) {
  selection::Workshop shop = servo_shop({.rate_mps = with_offset(0.0), .samples = 1000});
  shop.threads = 1;
  const selection::Stage stage = selection::first_stage(shop);
  std::vector<std::string> looked;
  static_cast<void>(selection::glances_at(
      shop, stage, shop.absent, [&](const std::string& effect) { looked.push_back(effect); }));
  EXPECT_EQ(looked.size(), shop.absent.size());
  shop.cancel = [] { return true; };
  EXPECT_TRUE(selection::glances_at(shop, stage, shop.absent).empty());
}

}  // namespace
}  // namespace workbench::diagnose
