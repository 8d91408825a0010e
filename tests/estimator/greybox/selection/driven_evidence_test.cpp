// The motion that the command makes tells nothing of a second mass so light that it shapes the
// answer to a disturbance alone. Truth: tests/truth.
#include "estimator/greybox/selection/driven_evidence.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using Values = std::map<std::string, double>;

/// A disturbed rig, and the model with an effect of this size as it is settled there.
struct Settled {
  SearchContext context = without_holdouts(
      diagnose_test::context_of("motion=multisine,length_s=12,outside.force_N=30", 646));
  InnovationStage bare = settled(context, first_stage(context), {}, Settling::once, {});

  double nats_of(const std::string& effect, const Values& values) const {
    InnovationStage stage = bare;
    FitSummary& fitted = stage.model.fitted;
    for (const plant_sim::EffectInfo& info : context.problem.candidate_effects) {
      if (info.name != effect) continue;
      for (const FreeParameter& p : effect_parameters(info, kEveryRefinement)) {
        const auto value = values.find(p.name);
        if (value == values.end()) continue;
        fitted.parameters.push_back(p);
        fitted.theta.conservativeResize(fitted.theta.size() + 1);
        fitted.theta[fitted.theta.size() - 1] = p.to_theta(value->second);
      }
    }
    stage.model.added = {effect};
    return driven_nats(context, stage, effect);
  }
};

TEST(DrivenEvidence, GrowsWithTheSquareOfAnEffectThatEntersLinearly) {
  const Settled on;
  const double once = on.nats_of("null_bias", {{"null_bias.offset_V", 1e-4}});
  const double twice = on.nats_of("null_bias", {{"null_bias.offset_V", 2e-4}});
  EXPECT_GT(once, 0.1);
  EXPECT_NEAR(twice / once, 4.0, 0.02);
}

TEST(DrivenEvidence, IsAlmostNoneOfASecondMassThatTheMotionHardlyMoves) {
  const Settled on;
  const auto of_share = [&](double mass_ratio) {
    return on.nats_of("second_mass", {{"second_mass.mass_ratio", mass_ratio},
                                      {"second_mass.resonance_Hz", 15.0},
                                      {"second_mass.damping_ratio", 0.02}});
  };
  EXPECT_LT(of_share(1e-3), 0.1);
  EXPECT_GT(of_share(0.4), 5.0);
}

}  // namespace
}  // namespace estimator::greybox::selection
