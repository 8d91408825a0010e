// A screening that is kept has the bits of one anew.
#include "estimator/greybox/selection/screening_memo.h"

#include <gmock/gmock.h>

#include <memory>
#include <vector>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

SearchContext short_record() {
  return diagnose_test::context_of(
      "motion=multisine,length_s=6,friction.coulomb_N=60,outside.force_N=10", 19);
}

std::vector<std::string> names_of(const std::vector<ScreeningResult>& screened) {
  std::vector<std::string> names;
  for (const ScreeningResult& one : screened) names.push_back(one.effect);
  return names;
}

TEST(ScreeningMemo, AScreeningThatIsKnownHasTheBitsOfOneAnew) {
  SearchContext context = short_record();
  const ModelStage first = first_stage(context);
  const std::vector<plant_sim::EffectInfo>& effects = context.problem.candidate_effects;
  const std::vector<ScreeningResult> anew = screen(context, first, effects);
  context.screenings = std::make_shared<ScreeningMemo>();
  // one half is known when all are asked for
  const auto middle = effects.begin() + static_cast<std::ptrdiff_t>(effects.size() / 2);
  (void)screen(context, first, {effects.begin(), middle});
  const std::vector<ScreeningResult> again = screen(context, first, effects);
  ASSERT_EQ(names_of(again), names_of(anew));
  for (std::size_t i = 0; i < anew.size(); ++i) {
    EXPECT_EQ(again[i].expected_ratio, anew[i].expected_ratio);
    ASSERT_EQ(again[i].starts.size(), anew[i].starts.size());
    for (std::size_t k = 0; k < anew[i].starts.size(); ++k)
      EXPECT_EQ(again[i].starts[k].start, anew[i].starts[k].start);
  }
}

TEST(ScreeningMemo, ASearchThatIsRepeatedEndsWhereItEnded) {
  SearchContext context = short_record();
  const ModelStage first = first_stage(context);
  const InnovationSearch without = search_innovations(context, first, {});
  ASSERT_FALSE(without.final.model.added.empty());
  context.screenings = std::make_shared<ScreeningMemo>();
  for (const unsigned threads : {2U, 1U}) {
    context.options.threads = threads;
    const InnovationSearch with = search_innovations(context, first, {});
    EXPECT_EQ(with.final.model.added, without.final.model.added);
    EXPECT_EQ(with.final.minus_two_log, without.final.minus_two_log);
    EXPECT_EQ(with.final.model.fitted.theta, without.final.model.fitted.theta);
  }
}

TEST(ScreeningMemo, KnowsAStageByItsResidualsAndAnEffectByItsDefinition) {
  SearchContext context = short_record();
  const ModelStage first = first_stage(context);
  const std::string key = ScreeningMemo::key_of(context, first);
  ModelStage other = first;
  other.fitted.residual_m[100] += 1e-9;
  EXPECT_NE(ScreeningMemo::key_of(context, other), key);
  other = first;
  other.fitted.theta[0] += 1e-12;
  EXPECT_NE(ScreeningMemo::key_of(context, other), key);
  SearchContext fewer = context;
  fewer.problem.trial_sizes /= 2;
  EXPECT_NE(ScreeningMemo::key_of(fewer, first), key);

  plant_sim::formula::FormulaEffect law;
  law.name = "drag";
  law.formula = "c*v_mps";
  law.parameters = {{.name = "c", .what = "drag", .min = -1.0, .max = 1.0, .typical = 1.0}};
  const auto key_of_law = [&] {
    SearchContext with = context;
    with.problem.model.declare(law, "test");
    const std::vector<plant_sim::EffectInfo> absent = absent_effects(with.problem.model);
    return ScreeningMemo::key_of(with, absent.back());
  };
  const std::string drag = key_of_law();
  law.formula = "c*abs(v_mps)*v_mps";
  EXPECT_NE(key_of_law(), drag);
}

}  // namespace
}  // namespace estimator::greybox::selection
