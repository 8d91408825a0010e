// The quick look and the fit that follows it, on servos of which the answer is known.
#include "workbench/diagnose/trial.h"

#include <gmock/gmock.h>

#include "tests/workbench/diagnose/servo_shop.h"
#include "workbench/diagnose/ladder.h"

namespace workbench::diagnose {
namespace {

using diagnose_test::servo_shop;
using diagnose_test::with_offset;

TEST(Glances, PutTheHiddenEffectFirstAndSayWhatItWillBring) {
  const Workshop shop = servo_shop({.rate_mps = with_offset(0.06)});
  const Stage stage = first_stage(shop);
  const std::vector<Glance> glances = preview(shop, stage);
  ASSERT_EQ(glances.size(), shop.absent.size());
  const Glance& first = glances.front();
  EXPECT_EQ(first.effect, "null_bias");
  // what the look expects of the squares, the fit brings
  const Trial trial = attempt(shop, first, {});
  EXPECT_NEAR(first.expected_ratio, trial.fitted.fit_rms_m / stage.fitted.fit_rms_m, 0.02);
  EXPECT_NEAR(trial.fitted.value("null_bias.offset_V"), 0.06, 3e-4);
  EXPECT_LT(trial.fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
}

TEST(Glances, BeginTheFitOnTheSideOfTheTruth) {
  const Workshop shop = servo_shop({.rate_mps = with_offset(-0.06)});
  const Stage stage = first_stage(shop);
  const Glance look = preview(shop, stage).front();
  ASSERT_EQ(look.searched.back().name, "null_bias.offset_V");
  const double start_V = look.searched.back().value(look.starts.front().tail(1)[0]);
  EXPECT_LT(start_V, 0.0);
  EXPECT_NEAR(attempt(shop, look, {}).fitted.value("null_bias.offset_V"), -0.06, 3e-4);
}

TEST(Glances, ExpectNothingOfAnyEffectOnAHealthyRecord) {
  const Workshop shop = servo_shop({.rate_mps = with_offset(0.0)});
  for (const Glance& look : preview(shop, first_stage(shop))) {
    EXPECT_GT(look.expected_ratio, 0.99) << look.effect;
    EXPECT_LE(look.expected_ratio, 1.0) << look.effect;
  }
}

TEST(Glances, FindALongWaveOfTheSensorBySizeLengthAndPhase) {
  constexpr double kTurn = 6.283185307179586;
  const Workshop shop =
      servo_shop({.rate_mps = with_offset(0.0), .reading_m = [](double y_m, double) {
                    return y_m + 4e-5 * std::sin(kTurn * y_m / 0.031 + 1.0);
                  }});
  const Glance look = preview(shop, first_stage(shop)).front();
  ASSERT_EQ(look.effect, "encoder_eccentricity");
  const matching::Fitted fitted = attempt(shop, look, {}).fitted;
  EXPECT_NEAR(fitted.value("encoder_eccentricity.amplitude_m"), 4e-5, 0.02 * 4e-5);
  EXPECT_NEAR(fitted.value("encoder_eccentricity.wavelength_m"), 0.031, 0.005 * 0.031);
  EXPECT_LT(fitted.score_rms_m, 1.1 * shop.evidence.noise_floor_m);
}

TEST(Glances, TellOfEachEffectOnceAndStopWhenCancelled) {
  Workshop shop = servo_shop({.rate_mps = with_offset(0.0), .samples = 1000});
  shop.threads = 1;
  const Stage stage = first_stage(shop);
  std::vector<std::string> looked;
  static_cast<void>(glances_at(shop, stage, shop.absent,
                               [&](const std::string& effect) { looked.push_back(effect); }));
  EXPECT_EQ(looked.size(), shop.absent.size());
  shop.cancel = [] { return true; };
  EXPECT_TRUE(preview(shop, stage).empty());
}

}  // namespace
}  // namespace workbench::diagnose
