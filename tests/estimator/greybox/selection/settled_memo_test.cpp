#include "estimator/greybox/selection/settled_memo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

SearchContext short_record(std::size_t seed) {
  return diagnose_test::context_of(
      "motion=multisine,length_s=6,friction.coulomb_N=60,outside.force_N=10", seed);
}

InnovationStage settled_once(const SearchContext& context, const ModelStage& from) {
  return settled(context, from, {}, Settling::once, SimulationWidth{});
}

std::string key_of(const SearchContext& context, const ModelStage& from) {
  return SettledMemo::key_of(context, from, {}, Settling::once, {});
}

void expect_same(const InnovationStage& one, const InnovationStage& other) {
  EXPECT_EQ(one.minus_two_log, other.minus_two_log);
  EXPECT_EQ(one.model.added, other.model.added);
  EXPECT_EQ(one.model.fitted.theta, other.model.fitted.theta);
  EXPECT_EQ(one.model.fitted.jacobian, other.model.fitted.jacobian);
  EXPECT_EQ(one.noise.noise.sensor_m, other.noise.noise.sensor_m);
  EXPECT_EQ(one.linear.front().speed_mps, other.linear.front().speed_mps);
  const FitDataset& data = one.context.problem.data;
  const FitDataset& other_data = other.context.problem.data;
  EXPECT_EQ(data.training_mask, other_data.training_mask);
  EXPECT_EQ(data.validation_mask, other_data.validation_mask);
  EXPECT_EQ(data.records.front().innovations->gain, other_data.records.front().innovations->gain);
}

TEST(SettledMemo, GivesTheStageThatWouldBeSettledAnew) {
  SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  const InnovationStage anew = settled_once(context, first);
  context.memo = std::make_shared<SettledMemo>();
  expect_same(settled_once(context, first), anew);
  expect_same(settled_once(context, first), anew);
}

TEST(SettledMemo, ServesAContextWithOtherCandidates) {
  const SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  InnovationStage marked = settled_once(context, first);
  marked.minus_two_log += 1.0;
  SearchContext other = context;
  other.memo = std::make_shared<SettledMemo>();
  other.problem.candidate_effects.clear();
  other.memo->keep(context, key_of(context, first), marked);
  const InnovationStage found = settled_once(other, first);
  EXPECT_EQ(found.minus_two_log, marked.minus_two_log);
  EXPECT_TRUE(found.context.problem.candidate_effects.empty());
}

TEST(SettledMemo, LeavesASearchAsItIs) {
  SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  const InnovationSearch without = search_innovations(context, first, {});
  ASSERT_FALSE(without.final.model.added.empty());
  context.memo = std::make_shared<SettledMemo>();
  (void)search_innovations(context, first, {}, {1, {}});
  EXPECT_GT(context.memo->size_bytes(), 0U);
  for (const unsigned threads : {1U, 2U}) {
    context.options.threads = threads;
    expect_same(search_innovations(context, first, {}).final, without.final);
  }
}

TEST(SettledMemo, DropsWhatWasNotAskedForTheLongest) {
  const SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  const InnovationStage stage = settled_once(context, first);
  SettledMemo large;
  large.keep(context, "a", stage);
  SettledMemo memo(large.size_bytes() * 5 / 2);
  memo.keep(context, "a", stage);
  memo.keep(context, "b", stage);
  EXPECT_TRUE(memo.find(context, "a"));
  memo.keep(context, "c", stage);
  EXPECT_TRUE(memo.find(context, "a"));
  EXPECT_FALSE(memo.find(context, "b"));
  EXPECT_TRUE(memo.find(context, "c"));
  EXPECT_EQ(memo.size_bytes(), 2 * large.size_bytes());
}

TEST(SettledMemo, KnowsTheLikeliestStageWithoutLinesOfARecord) {
  const SearchContext context = short_record(17);
  InnovationStage stage = settled_once(context, first_stage(context));
  SettledMemo memo;
  EXPECT_TRUE(std::isinf(memo.least_minus_two_log(context)));
  memo.keep(context, "a", stage);
  const double first = penalised(stage);
  stage.minus_two_log += 10.0;
  memo.keep(context, "b", stage);
  EXPECT_EQ(memo.least_minus_two_log(context), first);
  stage.minus_two_log -= 30.0;
  memo.keep(context, "c", stage);
  EXPECT_EQ(memo.least_minus_two_log(context), first - 20.0);
  stage.minus_two_log -= 100.0;
  stage.noise.lines.push_back({disturbance::LineSite::force, 20.0});
  memo.keep(context, "d", stage);
  EXPECT_EQ(memo.least_minus_two_log(context), first - 20.0) << "with a line";
  EXPECT_TRUE(std::isinf(memo.least_minus_two_log(short_record(18)))) << "another record";
}

// A candidate that is declared and not used changes nothing.
TEST(SettledMemo, KnowsAStageByWhatItFollowsFrom) {
  const SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  const std::string key = key_of(context, first);

  SearchContext other = context;
  other.problem.candidate_effects.clear();
  plant_sim::formula::FormulaEffect law;
  law.name = "drag";
  law.formula = "c*v_mps";
  law.parameters = {{.name = "c", .what = "drag", .min = -1.0, .max = 1.0, .typical = 1.0}};
  other.problem.model.declare(law, "test");
  EXPECT_EQ(key_of(other, first), key);

  EXPECT_NE(SettledMemo::key_of(context, first, {}, Settling::fully, {}), key);
  EXPECT_NE(SettledMemo::key_of(context, first, {}, Settling::once, wide(2)), key);
  EXPECT_EQ(SettledMemo::key_of(context, first, {}, Settling::once, {1, 2}), key);
  ModelStage moved = first;
  moved.fitted.theta[0] += 1e-12;
  EXPECT_NE(key_of(context, moved), key);
  moved = first;
  moved.fitted.parameters.front().prior_sd *= 2.0;
  EXPECT_NE(key_of(context, moved), key);
  disturbance::NoiseModel noise;
  noise.lines.push_back({disturbance::LineSite::force, 20.0});
  EXPECT_NE(SettledMemo::key_of(context, first, noise, Settling::once, {}), key);
  moved = first;
  moved.added.emplace_back("friction");
  EXPECT_NE(key_of(context, moved), key);
  other = context;
  other.problem.data.records.front().u_V[100] += 1e-9;
  EXPECT_NE(key_of(other, first), key);
  other = context;
  other.problem.data.all_mask[100] = 1.0 - other.problem.data.all_mask[100];
  EXPECT_NE(key_of(other, first), key);
  other = context;
  other.problem.data.noise_floor_m *= 1.5;
  EXPECT_NE(key_of(other, first), key);
  other = context;
  other.problem.data.records.front().name = "another";
  EXPECT_NE(key_of(other, first), key);
  other = context;
  other.problem.data.records.front().valid[100] ^= 1;
  EXPECT_NE(key_of(other, first), key);
  other = context;
  *other.problem.model.value("mass_kg") += 1.0;
  EXPECT_NE(key_of(other, first), key);
}

}  // namespace
}  // namespace estimator::greybox::selection
