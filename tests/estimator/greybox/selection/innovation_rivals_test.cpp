// Effects that explain a record about as well as the one chosen.
#include "estimator/greybox/selection/innovation_rivals.h"

#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <vector>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;

/// A stage of one effect, `behind_nats` less likely than another of the same parameters.
InnovationStage stage_of(const std::string& effect, double behind_nats) {
  InnovationStage stage;
  stage.model.added = {effect};
  stage.minus_two_log = 1000.0 + 2.0 * behind_nats;
  return stage;
}

TEST(InnovationRivals, AreThoseWithinWhatInexactModelsMayOwe) {
  const InnovationStage final = stage_of("transport_delay", 0.0);
  const std::vector<InnovationStage> others{stage_of("drive_lag", 20.0),
                                            stage_of("friction", 90.0)};
  EXPECT_THAT(rivals_among(final, "transport_delay", others, 0.0).names,
              ElementsAre("transport_delay"));
  EXPECT_THAT(rivals_among(final, "transport_delay", others, 30.0).names,
              ElementsAre("transport_delay", "drive_lag"));
}

// A command that is limited passes for a flow that is, until a pulsation is known that such a flow
// does not pass on.
TEST(RunnersUp, AreTriedAgainWithTheLinesThatCameIn) {
  SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=12,flow_saturation.limit_m3ps=6.5e-5,"
      "outside.pulsation_Pa=184000,outside.pulsation_Hz=28.4036",
      65024780007);
  context.options.threads = 2;
  const ModelStage first = first_stage(context);
  const auto settled_with = [&](const std::string& effect, double size,
                                const disturbance::NoiseModel& noise, Settling effort) {
    return settled(context, diagnose_test::stage_with(context, first, {{effect, size}}), noise,
                   effort, wide(2));
  };
  InnovationRound taken;
  taken.taken = true;
  for (const auto& [effect, size, gain_nats] : {std::tuple{"drive_saturation", 2.13, 3700.0},
                                                {"flow_saturation", 6.5e-5, 3400.0},
                                                {"internal_leakage", 1e-12, 600.0}}) {
    InnovationCandidate& candidate = taken.candidates.emplace_back();
    candidate.effect = effect;
    candidate.gain_nats = gain_nats;
    candidate.settled = true;
    candidate.fitted = settled_with(effect, size, {}, Settling::once).model.fitted;
  }
  disturbance::NoiseModel noise;
  noise.lines = {{disturbance::LineSite::supply, 28.4036}};
  const InnovationStage final = settled_with("drive_saturation", 2.13, noise, Settling::fully);

  std::vector<InnovationStage> exchanges;
  add_runners_up(context, final, "drive_saturation", {taken}, exchanges);
  ASSERT_EQ(exchanges.size(), 1U);
  EXPECT_THAT(exchanges.front().model.added, ElementsAre("flow_saturation"));
  EXPECT_LT(penalised(exchanges.front()), penalised(final) - 100.0);
  add_runners_up(context, final, "drive_saturation", {taken}, exchanges);
  EXPECT_EQ(exchanges.size(), 1U) << "tried twice";
}

}  // namespace
}  // namespace estimator::greybox::selection
