#include "estimator/greybox/selection/disturbance_report.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

double humming_m(double y_m, double t_s) { return y_m + 30e-6 * std::sin(107.0 * t_s); }

TEST(StructureSearchOfInnovations, HasOneErrorOfTheModelAsGiven) {
  SearchContext context = diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset_and_band(0.02, 0.05), .reading_m = humming_m});
  std::erase_if(context.problem.candidate_effects, [](const plant_sim::EffectInfo& effect) {
    return effect.name != "null_bias" && effect.name != "deadband";
  });
  const ModelStage first = first_stage(context);
  const InnovationSearch search = search_innovations(context, first, {first, {}});
  const StructureSearch found = structure_search_of(context, first, search);
  ASSERT_FALSE(found.final.added.empty());
  std::size_t plain = 0;
  for (const Round& round : found.rounds) {
    if (!round.before.added.empty()) continue;
    ++plain;
    EXPECT_EQ(round.before.fitted.validation_rms_m, found.path.front().fitted.validation_rms_m);
  }
  EXPECT_GT(plain, 0U);
}

// Friction and play let less of a disturbance through than their linearised models: what is stated
// is no more than the error that there is.
TEST(Conclusion, StatesNoDisturbanceBeyondTheError) {
  SearchContext context = diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset(0.0), .reading_m = humming_m});
  context.problem.candidate_effects.clear();
  const ModelStage first = first_stage(context);
  InnovationSearch search = search_innovations(context, first, {first, {}});
  ASSERT_EQ(search.final.noise.lines.size(), 1U);
  for (std::vector<Eigen::Vector2d>& waves : search.final.noise.waves) {
    for (Eigen::Vector2d& wave : waves) wave *= 1.4;
  }
  const std::optional<Disturbance> linear = disturbance_of(context, search);
  Diagnosis result;
  result.noise_floor_m = context.problem.data.noise_floor_m;
  conclude(context, context, first, search, result);
  ASSERT_TRUE(linear && result.disturbance);
  ASSERT_GT(linear->rms_m, 1.2 * result.rms_after_m);
  EXPECT_LE(result.disturbance->rms_m, result.rms_after_m);
  for (const DisturbanceLine& line : result.disturbance->lines) {
    EXPECT_LE(line.rms_m, result.disturbance->rms_m);
  }
}

}  // namespace
}  // namespace estimator::greybox::selection
