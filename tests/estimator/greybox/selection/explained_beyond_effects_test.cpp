// Changes in time and laws are told before further effects are sought, where they promise more.
#include "estimator/greybox/selection/explained_beyond_effects.h"

#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

/// The diagnosis by changes or laws, before an effect has been added; none: they explain nothing.
std::optional<Diagnosis> explained(const std::string& spec, bool effects_only = false) {
  SearchContext context = diagnose_test::context_of(spec, 29);
  context.problem.effects_only = effects_only;
  const ModelStage first = first_stage(context);
  Diagnosis d;
  d.noise_floor_m = context.problem.data.noise_floor_m;
  d.search.path = {first};
  d.search.final = first;
  SearchStart start;
  start.first = first;
  start.branch.stage = first;
  if (!explain_beyond_effects(context, start, d)) return {};
  EXPECT_LT(d.rms_after_m, 1.1 * d.floor_m());
  return d;
}

TEST(ExplainedBeyondEffects, AGainThatDriftsIsDated) {
  const std::string drift = "motion=chirp,length_s=15,left_out=gain_drift,left_out.size=0.06";
  const std::optional<Diagnosis> d = explained(drift);
  ASSERT_TRUE(d);
  EXPECT_EQ(d->verdict, Verdict::changing);
  ASSERT_THAT(d->changing, SizeIs(1));
  EXPECT_EQ(d->changing.front().kind, ChangeKind::ramp);
  EXPECT_THAT(d->missing, IsEmpty());
  EXPECT_FALSE(explained(drift, true));
}

TEST(ExplainedBeyondEffects, ALawIsLearned) {
  for (const char* disturbance : {"", ",outside.force_N=10"}) {
    const std::optional<Diagnosis> d =
        explained(std::string("motion=multisine,length_s=10,left_out=cubic_damping") + disturbance);
    ASSERT_TRUE(d) << disturbance;
    EXPECT_EQ(d->verdict, Verdict::learned);
    ASSERT_THAT(d->laws, SizeIs(1));
    EXPECT_EQ(d->laws.front().effect.name, "cubic_damping");
  }
}

// On a chirp what goes with the acceleration goes with the time too.
TEST(ExplainedBeyondEffects, AMountThatYieldsIsALawAndNoChange) {
  const std::optional<Diagnosis> d =
      explained("motion=chirp,length_s=15,left_out=mount_compliance,left_out.size=3e-5");
  ASSERT_TRUE(d);
  EXPECT_EQ(d->verdict, Verdict::learned);
  ASSERT_THAT(d->laws, SizeIs(1));
  EXPECT_EQ(d->laws.front().effect.name, "mount_compliance");
}

TEST(ExplainedBeyondEffects, NothingIsWhereAnEffectIsMissing) {
  for (const char* hidden : {"friction.coulomb_N=120", "spool_rate_limit.rate_mps=0.004",
                             "internal_leakage.conductance_m3ps_per_Pa=2e-12",
                             "quadratic_damping.coefficient_N_s2_per_m2=18000,outside.force_N=10",
                             "valve_hysteresis.half_width_V=0.1,outside.force_N=10"}) {
    EXPECT_FALSE(explained(std::string("motion=chirp,length_s=10,") + hidden)) << hidden;
  }
}

}  // namespace
}  // namespace estimator::greybox::selection
