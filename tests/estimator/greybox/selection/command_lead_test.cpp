// Records of the independent simulator, logged as other people's loggers do.
#include "estimator/greybox/selection/command_lead.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_with;
using diagnose_test::dataset_of;
using testing::ElementsAre;

Dataset record() {
  return dataset_of(truth::simulate(truth::parse_case("motion=multisine,length_s=20", 61)));
}

/// Every m-th sample.
Dataset thinned(const Dataset& whole, std::size_t m) {
  std::vector<double> u_V;
  std::vector<double> y_m;
  for (std::size_t k = 0; k < whole.size(); k += m) {
    u_V.push_back(whole.u_V[k]);
    y_m.push_back(whole.y_m[k]);
  }
  return estimator::greybox::dataset_of(whole.sample_time_s * static_cast<double>(m), u_V, y_m);
}

double lead_of(Dataset data) {
  const SearchContext context = context_with(std::move(data));
  return find_command_lead(context, first_stage(context)).samples;
}

TEST(CommandLead, InterpolatesWithinASegmentAndHoldsAtItsEnd) {
  FitDataset data;
  data.records.push_back(
      estimator::greybox::dataset_of(0.01, {1.0, 3.0, 7.0, 10.0, 20.0}, {0.0, 0.0, 0.0, 0.0, 0.0}));
  data.records.front().starts = {0, 3};
  FitDataset two = data;
  advance_command(data, 0.25);
  EXPECT_THAT(data.records.front().u_V, ElementsAre(1.5, 4.0, 7.0, 12.5, 20.0));
  advance_command(two, 1.5);
  EXPECT_THAT(two.records.front().u_V, ElementsAre(5.0, 7.0, 7.0, 20.0, 20.0));
}

TEST(CommandLead, ALogOfEveryOtherSampleIsAQuarterOfASampleOff) {
  EXPECT_EQ(lead_of(record()), 0.0);
  EXPECT_EQ(lead_of(thinned(record(), 2)), 0.25);
}

TEST(CommandLead, CommandsLoggedOneSampleLateAreNoticed) {
  Dataset late = record();
  std::copy_backward(late.u_V.begin(), late.u_V.end() - 1, late.u_V.end());
  EXPECT_EQ(lead_of(late), 1.0);
}

TEST(CommandLead, AMissingEffectIsNoLead) {
  EXPECT_EQ(lead_of(dataset_of(truth::simulate(truth::parse_case(
                "motion=multisine,length_s=20,valve_hysteresis.half_width_V=0.2", 62)))),
            0.0);
}

}  // namespace
}  // namespace estimator::greybox::selection
