// A drive that lags behind its command is told from one that acts late, on records of the
// independent simulator.
#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "tests/workbench/diagnose/judged.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::said;

selection::Diagnosis diagnosed_lag(const std::string& hidden) {
  const truth::Record record = truth::simulate(
      truth::parse_case("rig=linear_axis,motion=multisine,length_s=12," + hidden, 41));
  const auto model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                           "/config/models/force_driven_axis.toml");
  return diagnose_test::found_in(selection::SearchContext{
      selection::make_problem(model, greybox::fit_dataset({diagnose_test::dataset_of(record)}, {})),
      {}});
}

TEST(HiddenDriveLag, IsNamedWithItsTimeConstant) {
  const selection::Diagnosis d = diagnosed_lag("drive_lag.lag_s=0.006");
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::ElementsAre("drive_lag")) << said(d);
  for (const selection::ParameterValue& p : d.parameters) {
    if (p.name != "drive_lag.lag_s") continue;
    EXPECT_NEAR(p.value, 0.006, diagnose_test::kStdErrors * p.std_error + 6e-6);
  }
}

TEST(HiddenDriveLag, IsNotNamedWhereTheCommandActsLate) {
  const selection::Diagnosis d = diagnosed_lag("transport_delay.delay_s=0.006");
  EXPECT_THAT(d.missing, testing::ElementsAre("transport_delay")) << said(d);
}

}  // namespace
}  // namespace workbench::diagnose
