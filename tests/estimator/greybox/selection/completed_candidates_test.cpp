// Friction on soft bristles and play in the sensor look alike: which of them explains a record is
// told by fits that have ended.
#include "estimator/greybox/selection/completed_candidates.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/search_round.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;

TEST(CompletedCandidates, TheRivalThatExplainsARecordTakesThePlaceOfOneThatDoesNotQuite) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=16,friction.coulomb_N=30,"
      "friction.presliding_stiffness_N_per_m=1e6,noise_m=5e-6,encoder_m=1e-5",
      8802);
  const double floor_m = context.problem.data.noise_floor_m;
  const ModelStage first = first_stage(context);
  SearchBranch branch;
  branch.rounds = {single_round(context, first, 1)};
  const auto& candidates = branch.rounds.front().candidates;
  const auto play = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& one) {
    return one.effects == std::vector<std::string>{"backlash"};
  });
  ASSERT_NE(play, candidates.end());
  branch.stage = completed(context, first, *play);
  const double with_play_m = branch.stage.fitted.validation_rms_m;
  ASSERT_GT(with_play_m, 1.03 * floor_m);
  ASSERT_LT(with_play_m, kUnexplained * floor_m);
  complete_rivals(context, branch);
  EXPECT_THAT(branch.stage.added, ElementsAre("friction"));
  EXPECT_LT(branch.stage.fitted.validation_rms_m, 1.03 * floor_m);

  EXPECT_THAT(candidates.front().effects, ElementsAre("friction"));
  EXPECT_EQ(candidates.front().validation_rms_m, branch.stage.fitted.validation_rms_m);

  // as if the floor were lower: play, completed, leaves more and stays behind
  SearchContext lower = context;
  lower.problem.data.noise_floor_m = branch.stage.fitted.validation_rms_m / 1.05;
  complete_rivals(lower, branch);
  EXPECT_THAT(branch.stage.added, ElementsAre("friction"));
  EXPECT_THAT(candidates[1].effects, ElementsAre("backlash"));
  EXPECT_NEAR(candidates[1].validation_rms_m, with_play_m, 1e-3 * with_play_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
