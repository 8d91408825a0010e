#include "estimator/greybox/selection/disturbance_report.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace estimator::greybox::selection
