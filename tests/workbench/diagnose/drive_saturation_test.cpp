// A drive that saturates is named, on records of the independent simulator.
#include <gmock/gmock.h>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "tests/workbench/diagnose/judged.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::said;

TEST(HiddenDriveSaturation, IsNamedWithItsLimit) {
  const truth::Case of = truth::parse_case(
      "rig=linear_axis,motion=multisine,length_s=12,drive_saturation.limit_V=1.2", 41);
  const truth::Record record = truth::simulate(of);
  const auto model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                           "/config/models/force_driven_axis.toml");
  const selection::Diagnosis d = diagnose_test::found_in(selection::SearchContext{
      selection::make_problem(model, greybox::fit_dataset({diagnose_test::dataset_of(record)}, {})),
      {}});
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::ElementsAre("drive_saturation")) << said(d);
  diagnose_test::expect_values(d, of);
}

}  // namespace
}  // namespace workbench::diagnose
