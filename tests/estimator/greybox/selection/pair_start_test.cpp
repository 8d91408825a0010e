// Pairs of effects where two taken one after another leave physics.
#include "estimator/greybox/selection/structure_search.h"

#include <gmock/gmock.h>

#include "config/schema/document.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

SearchStart first_two_effects(const SearchContext& context) {
  SearchStart start = start_search(context);
  if (start.branch.stage.added.size() == 1) add_second_effect(context, start);
  return start;
}

TEST(PairStart, FindsTwoThatPassForTwoOthersOneByOne) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=30,external_leakage.conductance_m3ps_per_Pa=3.7e-13,"
      "load_force.force_N=-450",
      81);
  SearchStart start = first_two_effects(context);
  const double one_by_one_m = start.branch.stage.fitted.validation_rms_m;
  EXPECT_GT(one_by_one_m, 1.5 * context.problem.data.noise_floor_m) << "nothing to be found";
  prefer_pair(context, start);
  EXPECT_THAT(start.branch.stage.added,
              testing::UnorderedElementsAre("external_leakage", "load_force"));
  EXPECT_LT(start.branch.stage.fitted.validation_rms_m, 1.15 * context.problem.data.noise_floor_m);
}

TEST(PairStart, StaysWhereNoPairLeavesFarLess) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=20,left_out=cubic_damping,left_out.size=250000", 82);
  SearchStart start = first_two_effects(context);
  const std::vector<std::string> before = start.branch.stage.added;
  const double before_m = start.branch.stage.fitted.validation_rms_m;
  prefer_pair(context, start);
  EXPECT_EQ(start.branch.stage.added, before);
  EXPECT_EQ(start.branch.stage.fitted.validation_rms_m, before_m);
}

/// The generator's single rod as a data sheet has it, within some per cent.
constexpr const char* kRod = R"(
schema_version = 1
name = "rod"
plant = "hydraulic_cylinder"
step_s = 0.001
[parameters]
mass_kg = 190.0
cap_area_m2 = 20e-4
rod_side_area_m2 = 12e-4
stroke_m = 0.61
damping_N_s_per_m = 3200.0
cap_dead_volume_m3 = 2.1e-4
rod_dead_volume_m3 = 2e-4
bulk_modulus_Pa = 1.15e9
supply_pressure_Pa = 14.0e6
return_pressure_Pa = 3.0e5
rated_flow_m3ps = 6.667e-4
rated_drop_Pa = 3.5e6
rated_command_V = 10.0
valve_bandwidth_Hz = 20.8
valve_damping_ratio = 0.8
[initial]
y_m = 0.305
)";

TEST(PairStart, FindsADeadBandBehindAnOffsetThatHidesIt) {
  // on a single rod a leak or a load passes for the two; a random force keeps them from the noise
  const truth::Record record = truth::simulate(truth::parse_case(
      "rig=single_rod,motion=multisine,length_s=20,outside.force_N=60,deadband.half_width_V=0.3,"
      "null_bias.offset_V=0.15",
      93201));
  const SearchContext context{
      make_problem(plant_sim::read_model(config::schema::Document::parse(kRod, "rod")),
                   fit_dataset({diagnose_test::dataset_of(record)}, {})),
      {}};
  SearchStart start = first_two_effects(context);
  const double one_by_one_m = start.branch.stage.fitted.validation_rms_m;
  prefer_pair(context, start);
  EXPECT_THAT(start.branch.stage.added, testing::UnorderedElementsAre("deadband", "null_bias"));
  EXPECT_LT(start.branch.stage.fitted.validation_rms_m, 0.1 * one_by_one_m);
}

// Given as a servo, a single rod's offset is what its areas take back on average; its oil and mass
// keep the two from the noise.
TEST(LongPairStart, FindsTwoOfWhichNeitherHelpsAlone) {
  const truth::Record record = truth::simulate(truth::parse_case(
      "rig=single_rod,motion=fast_steps,length_s=15,null_bias.offset_V=-0.1863,"
      "plant.area_cap_m2=0.002,plant.area_rod_m2=0.001358,plant.supply_pressure_Pa=12.86e6",
      65025550005));
  plant_sim::ModelFile servo = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/velocity_servo.toml");
  *servo.value("gain_mps_per_V") = 0.05;
  *servo.value("time_constant_s") = 0.01;
  DiagnosisOptions options;
  options.threads = 2;
  const Diagnosis found =
      diagnose(make_problem(servo, fit_dataset({diagnose_test::dataset_of(record)}, {})), options);
  EXPECT_THAT(found.missing, testing::IsSupersetOf({"null_bias", "flow_asymmetry"}));
  EXPECT_NEAR(found.final.value("null_bias.offset_V"), -0.1863, 0.02);
}

}  // namespace
}  // namespace estimator::greybox::selection
