// How likely a gain is by chance, by counting; one round of trials.
#include "estimator/greybox/selection/search_round.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// 6000 samples at 200 Hz of which every other 2 s score.
SearchContext blocks() {
  SearchContext context;
  context.problem.data.sample_time_s = 0.005;
  context.problem.data.validation_mask = VectorXd::Zero(6000);
  for (Index k = 0; k < 6000; ++k)
    context.problem.data.validation_mask[k] = (k / 400) % 2 == 1 ? 1.0 : 0.0;
  return context;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  greybox::FitSummary residual(double sd_m, double phi = 0.0) {
    greybox::FitSummary fitted;
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
  const SearchContext context = blocks();
  for (const double phi : {0.0, 0.9}) {
    Noise noise(17);
    int at_5_percent = 0;
    int at_1_percent = 0;
    for (int i = 0; i < 400; ++i) {
      const double p = chance(context, noise.residual(1e-6, phi), noise.residual(1e-6, phi));
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
  const SearchContext context = blocks();
  Noise noise(4);
  const greybox::FitSummary earlier = noise.residual(1.2e-6);
  const greybox::FitSummary later = noise.residual(1e-6);
  EXPECT_LT(chance(context, earlier, later), 1e-4);
  EXPECT_NEAR(chance(context, earlier, later) + chance(context, later, earlier), 1.0, 1e-12);
}

TEST(Chance, LooksAtScoredSamplesOnly) {
  const SearchContext context = blocks();
  Noise noise(4);
  const greybox::FitSummary earlier = noise.residual(1e-6);
  const greybox::FitSummary later = noise.residual(1e-6);
  greybox::FitSummary other = later;
  for (Index k = 0; k < 6000; ++k) {
    if (context.problem.data.validation_mask[k] == 0.0) other.residual_m[k] = 1.0;
  }
  EXPECT_EQ(chance(context, earlier, later), chance(context, earlier, other));
}

TEST(Chance, IsCertainWithTooLittleToCount) {
  SearchContext context = blocks();
  context.problem.data.validation_mask.setZero();
  Noise noise(4);
  EXPECT_EQ(chance(context, noise.residual(2e-6), noise.residual(1e-6)), 1.0);
}

/// The error of `best` times a ratio, in every sample, left by a model of so many parameters.
Candidate scaled(const greybox::FitSummary& best, double ratio, std::size_t parameters) {
  Candidate candidate;
  candidate.effects = {"effect"};
  candidate.fitted.residual_m = ratio * best.residual_m;
  candidate.fitted.parameters.resize(parameters);
  candidate.fitted.theta = VectorXd::Zero(static_cast<Index>(parameters));
  candidate.validation_rms_m = ratio * 1e-6;
  candidate.fitted_at_all = true;
  return candidate;
}

// 3000 samples score: of the two ratios one loses 0.6 nats and the other 9, both in every sample.
TEST(Simplest, AParameterOfLessThanTwoNatsIsNotWorthItHoweverSteadyTheyAre) {
  const SearchContext context = blocks();
  const greybox::FitSummary best = Noise(4).residual(1e-6);
  for (const auto& [ratio, chosen] : {std::pair{1.0002, 1}, {1.003, 2}}) {
    const std::vector<Candidate> candidates{scaled(best, 1.0, 2), scaled(best, ratio, 1)};
    ASSERT_LT(chance(context, candidates[1].fitted, candidates[0].fitted), 1e-4);
    EXPECT_EQ(simplest(context, candidates).fitted.parameters.size(), chosen) << ratio;
  }
}

TEST(SingleRound, RanksTheHiddenEffectFirstAndTellsHowItGoes) {
  SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset(0.06)});
  std::vector<SearchProgress> told;
  context.options.progress = [&](const SearchProgress& progress) { told.push_back(progress); };
  const Round round = single_round(context, first_stage(context), 1);
  ASSERT_EQ(round.candidates.size(), context.problem.candidate_effects.size());
  const Candidate& best = round.candidates.front();
  EXPECT_THAT(best.effects, testing::ElementsAre("null_bias"));
  EXPECT_LT(best.p_value, 1e-6);
  EXPECT_GT(best.fitted.jacobian.size(), 0);
  for (std::size_t i = 1; i < round.candidates.size(); ++i) {
    if (!round.candidates[i].fitted_at_all) break;
    EXPECT_GE(round.candidates[i].validation_rms_m, round.candidates[i - 1].validation_rms_m);
  }
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back().done, told.back().of);
  EXPECT_EQ(told.back().best, "null_bias");
  EXPECT_EQ(told.back().expected.front(), "null_bias");
  EXPECT_EQ(told.back().round, 1);
}

TEST(SingleRound, FitsNothingWhereNoEffectPromisesEnough) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset(0.06)});
  const ModelStage first = first_stage(context);
  const double floor_m = context.problem.data.noise_floor_m;
  EXPECT_FALSE(single_round(context, first, 1, 5.0 * floor_m).candidates.empty());
  EXPECT_TRUE(single_round(context, first, 1, 0.5 * floor_m).candidates.empty());
}

TEST(SingleRound, LeavesOutWhatIsInTheModelAlready) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset(0.06)});
  const ModelStage stage =
      diagnose_test::stage_with(context, first_stage(context), {{"null_bias", 0.06}});
  for (const Candidate& candidate : single_round(context, stage, 2).candidates) {
    EXPECT_NE(candidate.effects.front(), "null_bias");
  }
}

TEST(PairRound, TriesEffectsTwoByTwoAndRanksTheTruePairFirst) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset_and_band(0.06, 0.1)});
  Round singles = single_round(context, first_stage(context), 1);
  std::erase_if(singles.candidates, [](const Candidate& candidate) {
    const std::string& effect = candidate.effects.front();
    return effect != "null_bias" && effect != "deadband" && effect != "flow_asymmetry";
  });
  const std::vector<Candidate> pairs = pair_round(context, singles);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_THAT(pairs.front().effects, testing::UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_LT(pairs.front().validation_rms_m, 1.1 * context.problem.data.noise_floor_m);
  const ModelStage both = with(singles.before, pairs.front());
  EXPECT_EQ(both.added, pairs.front().effects);
}

}  // namespace
}  // namespace estimator::greybox::selection
