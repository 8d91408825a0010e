// A second mass behind a spring, hidden in records from a matrix exponential (two_masses.h): named
// with its frequency, and not named where there is none.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <vector>

#include "config/schema/document.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/screening.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "tests/workbench/diagnose/judged.h"
#include "tests/workbench/diagnose/two_masses.h"
#include "workbench/diagnose/effect_words.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::said;

/// A rigid axis whose mass and damping are off.
plant_sim::ModelFile rigid() {
  plant_sim::ModelFile model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"axis\"\nplant = \"force_driven_axis\"\n[parameters]\n"
      "mass_kg = 33.0\ndamping_N_s_per_m = 100.0\ngain_N_per_V = 40.0\n",
      "axis"));
  return model;
}

selection::SearchContext context_of(const two_masses::Rig& rig) {
  config::record::Record record = two_masses::record(rig);
  record.name = "two masses";
  record.sample_time_s = 1.0 / rig.sample_rate_Hz;
  return {selection::make_problem(rigid(), greybox::fit_dataset({greybox::dataset_of(record)}, {})),
          {}};
}

selection::Diagnosis diagnosed_masses(const two_masses::Rig& rig) {
  return diagnose_test::found_in(context_of(rig));
}

const selection::ParameterValue& value(const selection::Diagnosis& d, const std::string& name) {
  const auto found = std::find_if(d.parameters.begin(), d.parameters.end(),
                                  [&](const auto& p) { return p.name == "second_mass." + name; });
  EXPECT_NE(found, d.parameters.end()) << name << " in " << said(d);
  static const selection::ParameterValue none{};
  return found == d.parameters.end() ? none : *found;
}

void expect_named(const two_masses::Rig& rig) {
  const selection::Diagnosis d = diagnosed_masses(rig);
  EXPECT_THAT(d.missing, testing::ElementsAre("second_mass")) << said(d);
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  const auto near = [&](const std::string& name, double truth) {
    const selection::ParameterValue& p = value(d, name);
    EXPECT_LT(std::abs(p.value - truth), diagnose_test::kStdErrors * p.std_error + 1e-3 * truth)
        << name << " is " << truth << ", found " << p.value << " +- " << p.std_error;
  };
  near("resonance_Hz", rig.resonance_Hz);
  near("damping_ratio", rig.damping_ratio);
  near("mass_ratio", rig.mass_ratio);
  EXPECT_THAT(effect_words(d, "second_mass"),
              testing::AllOf(testing::HasSubstr(" Hz, damping "),
                             testing::HasSubstr("a second mass behind a spring")));
}

TEST(HiddenSecondMass, IsNamedWithItsFrequencyAt34Hz) { expect_named({.seed = 3}); }

TEST(HiddenSecondMass, IsNamedWithItsFrequencyAt8HzAnd500HzSampling) {
  expect_named({.resonance_Hz = 8.0, .sample_rate_Hz = 500.0, .seed = 4});
}

// The rig's own force noise rings the spring as the command does.
TEST(HiddenSecondMass, IsNamedWhereAForceDisturbsTheMassThatTheSensorIsOn) {
  expect_named({.at_load = true, .sample_rate_Hz = 500.0, .second_disturbance_N = 2.0, .seed = 9});
  expect_named(
      {.resonance_Hz = 12.0, .sample_rate_Hz = 500.0, .driven_disturbance_N = 5.0, .seed = 10});
}

// The resonance that is screened is several hertz off: shares and dampings that were judged there
// are tried again where a fit moves it to.
TEST(HiddenSecondMass, IsNamedWithItsShareWhereAForceDisturbsTheMassBeyondItsSpring) {
  const selection::Diagnosis d = diagnosed_masses({.resonance_Hz = 17.0,
                                                   .at_load = true,
                                                   .sample_rate_Hz = 500.0,
                                                   .driven_disturbance_N = 5.0,
                                                   .seed = 5});
  EXPECT_THAT(d.missing, testing::ElementsAre("second_mass")) << said(d);
  EXPECT_NEAR(value(d, "resonance_Hz").value, 17.0, 0.2);
  const selection::ParameterValue& share = value(d, "mass_ratio");
  EXPECT_LT(share.std_error, 0.25);
  EXPECT_NEAR(share.value, 0.3, diagnose_test::kStdErrors * share.std_error);
}

// The plant's parameters follow a resonance some way: which side the sensor is on shows in a fit.
TEST(HiddenSecondMass, IsTriedWithTheSensorOnEitherSideOfItsSpring) {
  for (const bool at_load : {false, true}) {
    const selection::SearchContext context =
        context_of({.at_load = at_load, .duration_s = 4.0, .seed = 8});
    const std::vector<selection::ScreeningResult> screened = selection::screen(
        context, selection::first_stage(context), {*plant_sim::find_effect("second_mass")});
    ASSERT_THAT(screened, testing::SizeIs(1));
    std::set<bool> sides;
    for (const selection::ParameterSubset& start : screened.front().starts) {
      sides.insert(std::any_of(start.parameters.begin(), start.parameters.end(),
                               [](const auto& p) { return p.name == "second_mass.sensor_ratio"; }));
    }
    EXPECT_THAT(sides, testing::SizeIs(2)) << at_load;
  }
}

TEST(HiddenSecondMass, IsNotFoundInARigidAxisNorInADelayedOneNorInASpring) {
  const selection::Diagnosis healthy = diagnosed_masses({.mass_ratio = 0.0, .seed = 5});
  EXPECT_THAT(healthy.missing, testing::IsEmpty()) << said(healthy);
  const selection::Diagnosis delayed =
      diagnosed_masses({.mass_ratio = 0.0, .delay_samples = 4, .seed = 6});
  EXPECT_THAT(delayed.missing, testing::ElementsAre("transport_delay")) << said(delayed);
  const selection::Diagnosis sprung =
      diagnosed_masses({.mass_ratio = 0.0, .stiffness_N_per_m = 1500.0, .seed = 7});
  EXPECT_THAT(sprung.missing, testing::Contains("load_spring")) << said(sprung);
  EXPECT_THAT(sprung.missing, testing::Not(testing::Contains("second_mass"))) << said(sprung);
}

TEST(LongHiddenSecondMass, IsNotNamedWhereTheMountOfTheSensorShakes) {
  const selection::Diagnosis d = diagnose_test::found_in(diagnose_test::context_of(
      "motion=multisine,length_s=12,friction.coulomb_N=105,friction.static_N=140,"
      "outside.force_N=30,outside.shake_m=9e-6,outside.shake_Hz=42.5",
      31));
  EXPECT_THAT(d.missing, testing::ElementsAre("friction")) << said(d);
}

}  // namespace
}  // namespace workbench::diagnose
