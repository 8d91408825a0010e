// Effects that explain a record about as well as the one chosen.
#include "estimator/greybox/selection/innovation_rivals.h"

#include <gmock/gmock.h>

#include <string>

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

}  // namespace
}  // namespace estimator::greybox::selection
