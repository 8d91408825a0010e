// A record begins where its rig was; a simulation begins where the model says. An effect that only
// makes up for the difference is not missing.
#include <gmock/gmock.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

/// The data sheet of the truth generator's single rod.
plant_sim::ModelFile single_rod() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/single_rod_cylinder.toml");
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, double>>{
           {"cap_area_m2", 2.0e-3}, {"rod_side_area_m2", 1.2e-3}, {"stroke_m", 0.61}}) {
    *model.value(name) = value;
  }
  return model;
}

// The overlap of the valve holds chamber pressures that the model's start does not have. A limit of
// the spool's rate once followed the first tenth of a second instead.
TEST(StartState, NoEffectStandsInForIt) {
  const truth::Record truth = truth::simulate(truth::parse_case(
      "rig=single_rod,motion=multisine,length_s=12,deadband.half_width_V=0.4", 92));
  const Diagnosis d =
      diagnose(make_problem(single_rod(), fit_dataset({diagnose_test::dataset_of(truth)}, {})), {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("deadband"));
}

}  // namespace
}  // namespace estimator::greybox::selection
