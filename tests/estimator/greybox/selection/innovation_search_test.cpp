// Searches on disturbed records of the independent simulator (tests/truth).
#include "estimator/greybox/selection/innovation_search.h"

#include <gmock/gmock.h>

#include <string>

#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

InnovationSearch searched(const std::string& spec, std::size_t seed) {
  SearchContext context = diagnose_test::context_of(spec, seed);
  context.options.threads = 2;
  return search_innovations(context, first_stage(context), {});
}

// Without the line, a resonance passes for the oil that the pulsation shakes.
TEST(InnovationSearch, AnEffectTakenBeforeALineIsExchangedForTheRightOne) {
  const InnovationSearch found = searched(
      "motion=multisine,length_s=15,entrained_air.fraction_ratio=0.25,"
      "outside.pulsation_Pa=192015,outside.pulsation_Hz=16.459",
      535660023);
  ASSERT_FALSE(found.rounds.empty());
  EXPECT_THAT(found.rounds.front().candidates.front().effect, testing::Ne("entrained_air"));
  EXPECT_THAT(found.final.model.added, ElementsAre("entrained_air"));
  EXPECT_FALSE(found.physics_missing());
}

// A flow at its limit passes no pulsation; a linear response to it would leave its difference.
TEST(InnovationSearch, APulsationBehindALimitedFlowLeavesNothing) {
  const InnovationSearch found = searched(
      "motion=multisine,length_s=15,flow_saturation.limit_m3ps=6.33e-5,"
      "outside.pulsation_Pa=130000,outside.pulsation_Hz=19.3725",
      539180049);
  EXPECT_THAT(found.final.model.added, ElementsAre("flow_saturation"));
  EXPECT_FALSE(found.physics_missing());
  EXPECT_LT(found.final.noise.noise.disturbance_sd, 1.0);
}

TEST(InnovationSearch, ALinesFrequencyIsFoundToASmallPartOfABin) {
  constexpr double kFrequency_Hz = 41.3217;
  const InnovationSearch found =
      searched("motion=multisine,length_s=20,outside.shake_m=4e-5,outside.shake_Hz=41.3217", 77);
  EXPECT_THAT(found.final.model.added, IsEmpty());
  ASSERT_THAT(found.final.noise.lines, SizeIs(1));
  EXPECT_NEAR(found.final.noise.lines.front().frequency_Hz, kFrequency_Hz, 1.5e-4);
}

}  // namespace
}  // namespace estimator::greybox::selection
