#include "estimator/greybox/selection/settled_memo.h"

#include <gtest/gtest.h>

#include <memory>

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
  return settled(context, from, {}, 1, SimulationWidth{});
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
  EXPECT_TRUE(context.memo->find(context, SettledMemo::key_of(context, first, {}, 1)));
}

// A candidate that is declared and not used changes nothing.
TEST(SettledMemo, KnowsAStageByWhatItFollowsFrom) {
  const SearchContext context = short_record(17);
  const ModelStage first = first_stage(context);
  const std::string key = SettledMemo::key_of(context, first, {}, 1);

  SearchContext other = context;
  other.problem.candidate_effects.clear();
  plant_sim::formula::FormulaEffect law;
  law.name = "drag";
  law.formula = "c*v_mps";
  law.parameters = {{.name = "c", .what = "drag", .min = -1.0, .max = 1.0, .typical = 1.0}};
  other.problem.model.declare(law, "test");
  EXPECT_EQ(SettledMemo::key_of(other, first, {}, 1), key);

  EXPECT_NE(SettledMemo::key_of(context, first, {}, 2), key);
  ModelStage moved = first;
  moved.fitted.theta[0] += 1e-12;
  EXPECT_NE(SettledMemo::key_of(context, moved, {}, 1), key);
  moved = first;
  moved.fitted.parameters.front().prior_sd *= 2.0;
  EXPECT_NE(SettledMemo::key_of(context, moved, {}, 1), key);
  disturbance::NoiseModel noise;
  noise.lines.push_back({disturbance::LineSite::force, 20.0});
  EXPECT_NE(SettledMemo::key_of(context, first, noise, 1), key);
  other = context;
  other.problem.data.records.front().u_V[100] += 1e-9;
  EXPECT_NE(SettledMemo::key_of(other, first, {}, 1), key);
  other = context;
  other.problem.data.records.front().valid[100] ^= 1;
  EXPECT_NE(SettledMemo::key_of(other, first, {}, 1), key);
  other = context;
  *other.problem.model.value("mass_kg") += 1.0;
  EXPECT_NE(SettledMemo::key_of(other, first, {}, 1), key);
}

}  // namespace
}  // namespace estimator::greybox::selection
