// Doubts about effects of a model that leaves no more than noise.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/estimator/greybox/selection/named_doubts.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::named;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(DoubtsAtTheNoise, NoEffectIsEstablishedWhereAllOfThePlantIsAtItsBounds) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.missing = {"transport_delay"};
  d.parameters = {{"gain_mps_per_V", 0.2, 0.0, true},
                  {"time_constant_s", 1.0, 0.0, true},
                  {"transport_delay.delay_s", 0.054, 0.001, false}};
  EXPECT_THAT(named(d), ElementsAre("transport_delay stand_in"));
  weigh_doubts(d);
  EXPECT_EQ(d.verdict, Verdict::undetermined);
  d.parameters[0].at_bound = false;
  EXPECT_THAT(named(d), IsEmpty());
}

// The best of 40 gains with p 0.0005 once in 50 healthy records.
TEST(DoubtsAtTheNoise, TheBestOfManyMayGainALittleByChance) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.missing = {"friction", "external_leakage"};
  d.parameters = {{"friction.coulomb_N", 200.0, 5.0, false},
                  {"external_leakage.conductance_m3ps_per_Pa", 1e-12, 2e-13, false}};
  d.noise_floor_m = 2e-6;
  d.rms_before_m = 2.5e-5;
  d.rms_after_m = 2.07e-6;
  d.steps = {{"", 2.5e-5}, {"friction", 2.15e-6}, {"external_leakage", 2.07e-6}};
  std::vector<Candidate> all(40);
  all[3].effects = {"external_leakage"};
  all[3].fitted_at_all = true;
  all[3].p_value = 0.0005;
  d.search.rounds = {Round{{}, all}};
  EXPECT_THAT(named(d), ElementsAre("external_leakage chance"));
  d.search.rounds[0].candidates[3].p_value = 0.0001;
  EXPECT_THAT(named(d), IsEmpty());
  d.search.rounds[0].candidates[3].p_value = 0.0005;
  d.search.rounds[0].candidates.resize(10);
  EXPECT_THAT(named(d), IsEmpty());
  d.search.rounds[0].candidates = all;
  // the step of another effect, whose name holds its own, removes more
  d.steps.insert(d.steps.begin() + 2, {"my_external_leakage", 2.14e-6});
  d.steps[1].validation_rms_m = 8e-6;
  EXPECT_THAT(named(d), ElementsAre("external_leakage chance"));
  d.steps[2].validation_rms_m = 4e-6;  // it removes more than the noise
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(DoubtsAtTheNoise, NoEffectIsEstablishedBesideSeveralParametersAtTheirBounds) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.missing = {"internal_leakage"};
  d.parameters = {{"mass_kg", 52.3, 0.4, false},
                  {"bulk_modulus_Pa", 9.3e8, std::nan(""), true},
                  {"supply_pressure_Pa", 6.3e6, 1e5, false},
                  {"internal_leakage.conductance_m3ps_per_Pa", 5e-11, 1e-12, false}};
  d.noise_floor_m = 2e-6;
  d.rms_after_m = 2.2e-6;
  EXPECT_THAT(named(d), IsEmpty());
  d.parameters[2].at_bound = true;
  EXPECT_THAT(named(d), ElementsAre("internal_leakage strained"));
  d.rms_after_m = 2.08e-6;
  EXPECT_THAT(named(d), IsEmpty());
  d.rms_after_m = 2.2e-6;
  weigh_doubts(d);
  EXPECT_EQ(d.verdict, Verdict::undetermined);
}

TEST(DoubtsAtTheNoise, AnEffectThatTheMotionHardlyShowsIsNotEstablished) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.missing = {"second_mass"};
  d.parameters = {{"second_mass.mass_ratio", 0.0158, 1e-4, false}};
  EXPECT_THAT(named(d), IsEmpty());
  d.undriven = {"second_mass"};
  EXPECT_THAT(named(d), ElementsAre("second_mass undriven"));
}

}  // namespace
}  // namespace estimator::greybox::selection
