// Records of the independent simulator, logged as other people's loggers do.
#include "estimator/greybox/selection/command_lead.h"

#include <gmock/gmock.h>

#include <numeric>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
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
  const ModelStage first = first_stage(context);
  return find_command_lead(context, first, first).samples;
}

FitDataset two_segments(const std::vector<double>& u_V) {
  FitDataset data;
  data.records.push_back(
      estimator::greybox::dataset_of(0.01, u_V, std::vector<double>(u_V.size(), 0.0)));
  data.records.front().starts = {0, 8};
  return data;
}

TEST(CommandLead, ShiftsByWholeSamplesAndHoldsAtASegmentsEnd) {
  std::vector<double> u_V(12);
  std::iota(u_V.begin(), u_V.end(), 0.0);
  FitDataset data = two_segments(u_V);
  advance_command(data, 2.0);
  EXPECT_FALSE(data.records.front().command_is_interpolated);
  EXPECT_THAT(data.records.front().u_V, ElementsAre(2, 3, 4, 5, 6, 7, 7, 7, 10, 11, 11, 11));
}

TEST(CommandLead, ASegmentDoesNotSeeTheNext) {
  std::vector<double> u_V(12, 5.0);
  std::fill(u_V.begin(), u_V.begin() + 8, 1.0);
  FitDataset data = two_segments(u_V);
  advance_command(data, 0.45);
  EXPECT_TRUE(data.records.front().command_is_interpolated);
  for (std::size_t k = 0; k < u_V.size(); ++k) {
    EXPECT_NEAR(data.records.front().u_V[k], u_V[k], 1e-12) << k;
  }
}

TEST(CommandLead, ALogOfEveryOtherSampleIsAQuarterOfASampleOff) {
  EXPECT_EQ(lead_of(record()), 0.0);
  EXPECT_EQ(lead_of(thinned(record(), 2)), 0.25);
}

// With another valve and another mass 1/3 of a sample leaves as little as the 1/4 that it is.
TEST(CommandLead, OfLeadsThatLeaveAsLittleTheOneNearTheFileIsTaken) {
  for (const std::size_t seed : {62, 63, 64}) {
    const Dataset whole = dataset_of(truth::simulate(truth::parse_case("motion=multisine", seed)));
    EXPECT_EQ(lead_of(thinned(whole, 2)), 0.25) << seed;
    EXPECT_NEAR(lead_of(thinned(whole, 3)), 1.0 / 3.0, 1e-12) << seed;
    const Dataset off =
        dataset_of(truth::simulate(truth::parse_case("motion=multisine,mismatched=1", seed)));
    EXPECT_EQ(lead_of(thinned(off, 2)), 0.25) << seed;
  }
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

// With a lead of 1.5 samples and a leak a simulation comes near to the noise floor, as it does with
// the mount that yields; the lead alone leaves 30 times what the model leaves without it.
TEST(CommandLead, IsNoneWhereItLeavesMoreWithoutTheEffect) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,left_out=mount_compliance,left_out.size=2.969117943e-05,plant.mass_kg="
      "51.02151906,plant.damping_N_s_per_m=1003.031374,plant.bulk_modulus_Pa=687162257.9,"
      "plant.dead_volume_m3=9.551251975e-06,plant.supply_pressure_Pa=6767673.546,"
      "plant.valve_gain_m_per_V=2.8574524e-05,plant.valve_natural_frequency_rad_per_s=576.686861,"
      "plant.valve_damping_ratio=0.6679733909",
      3134110008);
  const ModelStage first = first_stage(context);
  const ModelStage leaking =
      diagnose_test::stage_with(context, first, {{"internal_leakage", 2e-12}});
  ModelStage far = first;
  far.fitted.validation_rms_m = 1.0;
  EXPECT_EQ(find_command_lead(context, far, leaking).samples, 1.5);
  EXPECT_EQ(find_command_lead(context, first, leaking).samples, 0.0);
}

// Without the lead a second mass of many parameters leaves as little as the friction that is
// missing, and no lead lowers that.
TEST(CommandLead, IsSoughtBesideTheRivalsOfTheFirstEffectToo) {
  const SearchContext context =
      context_with(thinned(dataset_of(truth::simulate(truth::parse_case(
                               "motion=multisine,mismatched=1,friction.coulomb_N=150", 8011))),
                           2));
  const SearchStart start = start_search(context);
  EXPECT_EQ(find_command_lead(context, start.first, start.branch.stage).samples, 0.0);
  EXPECT_EQ(find_command_lead(context, start).samples, 0.25);
}

}  // namespace
}  // namespace estimator::greybox::selection
