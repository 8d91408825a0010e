// How likely a gain is by chance, by counting; one round of trials.
#include "estimator/greybox/selection/search_round.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/workbench/diagnose/servo_shop.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// 6000 samples at 200 Hz of which every other 2 s score.
selection::Workshop blocks() {
  selection::Workshop shop;
  shop.evidence.sample_time_s = 0.005;
  shop.evidence.scores = VectorXd::Zero(6000);
  for (Index k = 0; k < 6000; ++k) shop.evidence.scores[k] = (k / 400) % 2 == 1 ? 1.0 : 0.0;
  return shop;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  greybox::Fitted residual(double sd_m, double phi = 0.0) {
    greybox::Fitted fitted;
    fitted.residual_m.resize(6000);
    double value = 0.0;
    for (double& r : fitted.residual_m) {
      value = phi * value + std::sqrt(1.0 - phi * phi) * white_(random_);
      r = sd_m * value;
    }
    return fitted;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> white_{0.0, 1.0};
};

// Counts of 400 draws at a chance of 5 % and 1 % lie within 20 +- 13 and 4 +- 6.
TEST(Chance, IsWhatItSaysWhenNeitherIsBetter) {
  const selection::Workshop shop = blocks();
  for (const double phi : {0.0, 0.9}) {
    Noise noise(17);
    int at_5_percent = 0;
    int at_1_percent = 0;
    for (int i = 0; i < 400; ++i) {
      const double p =
          selection::chance(shop, noise.residual(1e-6, phi), noise.residual(1e-6, phi));
      ASSERT_GE(p, 0.0);
      ASSERT_LE(p, 1.0);
      at_5_percent += p < 0.05 ? 1 : 0;
      at_1_percent += p < 0.01 ? 1 : 0;
    }
    EXPECT_NEAR(at_5_percent, 20, 13) << phi;
    EXPECT_NEAR(at_1_percent, 4, 6) << phi;
  }
}

TEST(Chance, IsSmallForASteadyGainAndLargeForASteadyLoss) {
  const selection::Workshop shop = blocks();
  Noise noise(4);
  const greybox::Fitted earlier = noise.residual(1.2e-6);
  const greybox::Fitted later = noise.residual(1e-6);
  EXPECT_LT(selection::chance(shop, earlier, later), 1e-4);
  EXPECT_NEAR(selection::chance(shop, earlier, later) + selection::chance(shop, later, earlier),
              1.0, 1e-12);
}

TEST(Chance, LooksAtScoredSamplesOnly) {
  const selection::Workshop shop = blocks();
  Noise noise(4);
  const greybox::Fitted earlier = noise.residual(1e-6);
  const greybox::Fitted later = noise.residual(1e-6);
  greybox::Fitted other = later;
  for (Index k = 0; k < 6000; ++k) {
    if (shop.evidence.scores[k] == 0.0) other.residual_m[k] = 1.0;
  }
  EXPECT_EQ(selection::chance(shop, earlier, later), selection::chance(shop, earlier, other));
}

TEST(Chance, IsCertainWithTooLittleToCount) {
  selection::Workshop shop = blocks();
  shop.evidence.scores.setZero();
  Noise noise(4);
  EXPECT_EQ(selection::chance(shop, noise.residual(2e-6), noise.residual(1e-6)), 1.0);
}

TEST(SingleRound, RanksTheHiddenEffectFirstAndTellsHowItGoes) {
  selection::Workshop shop =
      diagnose_test::servo_shop({.rate_mps = diagnose_test::with_offset(0.06)});
  std::vector<selection::Progress> told;
  shop.progress = [&](const selection::Progress& progress) { told.push_back(progress); };
  const selection::Round round = selection::single_round(shop, selection::first_stage(shop), 1);
  ASSERT_EQ(round.candidates.size(), shop.absent.size());
  const selection::Candidate& best = round.candidates.front();
  EXPECT_THAT(best.effects, testing::ElementsAre("null_bias"));
  EXPECT_LT(best.p_value, 1e-6);
  EXPECT_GT(best.fitted.jacobian.size(), 0);
  for (std::size_t i = 1; i < round.candidates.size(); ++i) {
    if (!round.candidates[i].fitted_at_all) break;
    EXPECT_GE(round.candidates[i].score_rms_m, round.candidates[i - 1].score_rms_m);
  }
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().done, told.back().of);
  EXPECT_EQ(told.back().best, "null_bias");
  EXPECT_EQ(told.back().expected.front(), "null_bias");
  EXPECT_THAT(told.back().doing, testing::StartsWith("round 1: "));
}

TEST(SingleRound, LeavesOutWhatIsInTheModelAlready) {
  const selection::Workshop shop =
      diagnose_test::servo_shop({.rate_mps = diagnose_test::with_offset(0.06)});
  const selection::Stage stage =
      diagnose_test::stage_with(shop, selection::first_stage(shop), {{"null_bias", 0.06}});
  for (const selection::Candidate& candidate : selection::single_round(shop, stage, 2).candidates) {
    EXPECT_NE(candidate.effects.front(), "null_bias");
  }
}

TEST(PairRound, TriesEffectsTwoByTwoAndRanksTheTruePairFirst) {
  const selection::Workshop shop =
      diagnose_test::servo_shop({.rate_mps = diagnose_test::with_offset_and_band(0.06, 0.1)});
  selection::Round singles = selection::single_round(shop, selection::first_stage(shop), 1);
  std::erase_if(singles.candidates, [](const selection::Candidate& candidate) {
    const std::string& effect = candidate.effects.front();
    return effect != "null_bias" && effect != "deadband" && effect != "flow_asymmetry";
  });
  const std::vector<selection::Candidate> pairs = selection::pair_round(shop, singles);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_THAT(pairs.front().effects, testing::UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_LT(pairs.front().score_rms_m, 1.1 * shop.evidence.noise_floor_m);
  const selection::Stage both = selection::with(singles.before, pairs.front());
  EXPECT_EQ(both.added, pairs.front().effects);
}

}  // namespace
}  // namespace workbench::diagnose
