// A record begins where its rig was; a simulation begins where the model says. An effect that only
// makes up for the difference is not missing.
#include <gmock/gmock.h>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

// The overlap of the valve holds chamber pressures that the model's start does not have. A limit of
// the spool's rate once followed the first tenth of a second instead.
TEST(StartState, NoEffectStandsInForIt) {
  const truth::Record truth = truth::simulate(truth::parse_case(
      "rig=single_rod,motion=multisine,length_s=12,deadband.half_width_V=0.4", 92));
  const Diagnosis d = diagnose(make_problem(diagnose_test::single_rod(),
                                            fit_dataset({diagnose_test::dataset_of(truth)}, {})),
                               {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("deadband"));
}

}  // namespace
}  // namespace estimator::greybox::selection
