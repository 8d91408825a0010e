#include "estimator/greybox/selection/confidence.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <utility>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/named_doubts.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::named;
using testing::ElementsAre;
using testing::IsEmpty;

Diagnosis unexplained() {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.missing = {"friction", "backlash"};
  d.parameters = {{"mass_kg", 50.0, 1.0, false},
                  {"friction.coulomb_N", 150.0, 4.0, false},
                  {"friction.static_N", 10.0, 40.0, false},
                  {"backlash.width_m", 5e-6, 7e-6, false}};
  return d;
}

TEST(Confidence, ASizeWithinItsErrorIsNotEstablishedWhateverItsRefinements) {
  EXPECT_THAT(named(unexplained()), ElementsAre("backlash within_error"));
}

TEST(Confidence, AWavelengthMakesNoAmplitudeWithinItsErrorSure) {
  Diagnosis d = unexplained();
  d.missing = {"encoder_eccentricity"};
  d.parameters = {{"encoder_eccentricity.amplitude_m", 18e-6, 73e-6, false},
                  {"encoder_eccentricity.wavelength_m", 4.8e-3, 1e-4, false}};
  EXPECT_THAT(named(d), ElementsAre("encoder_eccentricity within_error"));
}

TEST(Confidence, AnEffectOfTheModelIsSureByAnyOfItsRefinements) {
  Diagnosis d = unexplained();
  d.missing = {"friction"};
  d.parameters = {{"friction.coulomb_N", 150.0, 4.0, false},
                  {"friction.static_N", 10.0, 40.0, false},
                  {"friction.presliding_stiffness_N_per_m", 1e7, 9e6, false}};
  d.parameters.front().in_model = true;
  d.in_file = {"friction"};
  EXPECT_THAT(named(d), ElementsAre("friction within_error")) << "its Coulomb part is known";
  d.parameters.back().std_error = 1e5;
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, AnUnsteadyGainIsNotEstablishedWhereAnErrorRemains) {
  Diagnosis d = unexplained();
  d.rms_before_m = 5e-3;
  d.rms_after_m = 1e-3;
  d.steps = {{"", 5e-3}, {"friction", 1e-3}, {"backlash", 1e-3}};
  Candidate friction;
  friction.effects = {"friction"};
  friction.fitted_at_all = true;
  friction.p_value = 0.2;
  d.search.rounds = {Round{{}, {friction}}};
  EXPECT_THAT(named(d), ElementsAre("friction chance", "backlash within_error"));
  double& p = d.search.rounds[0].candidates[0].p_value;
  p = 0.02;
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  p = 1.0;  // not known
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  p = 0.2;
  d.by_innovations = true;
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  d.by_innovations = false;
  d.steps[1].validation_rms_m = d.rms_after_m = 1e-4;  // it explains nearly everything
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  d.rms_after_m = 1e-3;
  d.verdict = Verdict::missing;  // the error is at the floor
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
}

TEST(Confidence, WhatDriftsIsNoOffset) {
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.missing = {"null_bias"};
  d.parameters = {{"null_bias.offset_V", -0.091, 0.023, false}};
  d.rms_before_m = 5e-3;
  d.rms_after_m = 1e-3;
  d.steps = {{"", 5e-3}, {"null_bias", 1e-3}};
  d.where = {{"flow", "v", 0.98}};
  EXPECT_THAT(named(d), IsEmpty());
  d.where = {{"flow", "time", 0.98}};
  EXPECT_THAT(named(d), ElementsAre("null_bias stand_in"));
}

TEST(Confidence, NothingIsMissingForSureWhereNoEffectIsEstablished) {
  Diagnosis d = unexplained();
  d.verdict = Verdict::missing;
  weigh_doubts(d);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.established(), ElementsAre("friction"));
  d.parameters[1].std_error = d.parameters[1].value;
  weigh_doubts(d);
  EXPECT_EQ(d.verdict, Verdict::undetermined);
  EXPECT_THAT(d.established(), IsEmpty());
}

TEST(Confidence, NothingIsLearnedWhereALawIsNotEstablished) {
  for (const char* law : {"friction", "backlash"}) {
    Diagnosis d = unexplained();
    d.verdict = Verdict::learned;
    d.laws.emplace_back();
    d.laws.front().effect.name = law;
    weigh_doubts(d);
    // the backlash is within its error
    EXPECT_EQ(d.verdict == Verdict::learned, law == std::string("friction")) << law;
  }
}

TEST(Confidence, ALawThatIsNotEstablishedAtTheFloorIsUndetermined) {
  for (const double times : {1.0, 3.0}) {
    Diagnosis d = unexplained();
    d.verdict = Verdict::learned;
    d.laws.emplace_back();
    d.laws.front().effect.name = "backlash";
    d.noise_floor_m = 2e-6;
    d.rms_after_m = times * d.floor_m();
    weigh_doubts(d);
    EXPECT_EQ(d.verdict, times > 2.0 ? Verdict::unexplained : Verdict::undetermined) << times;
    // the error that remains beside such a law is a doubt on the friction
    EXPECT_EQ(d.established().empty(), times > 2.0) << times;
  }
}

TEST(Confidence, NothingIsEstablishedWhereMostOfThePlantIsAtItsBoundsAndAnErrorRemains) {
  Diagnosis d = unexplained();
  for (const char* name : {"bulk_modulus_Pa", "supply_pressure_Pa", "dead_volume_m3"})
    d.parameters.push_back({name, 1.0, std::nan(""), true});
  weigh_doubts(d);
  EXPECT_THAT(d.established(), IsEmpty());
  d.parameters.back().at_bound = false;
  weigh_doubts(d);
  EXPECT_THAT(d.established(), ElementsAre("friction"));
}

TEST(Confidence, BesideAPlantAtItsBoundsAnEffectHasToHelpASimulation) {
  Diagnosis d = unexplained();
  d.verdict = Verdict::missing;
  d.by_innovations = true;
  d.parameters[3].std_error = 0.1 * d.parameters[3].value;
  for (const char* name : {"bulk_modulus_Pa", "supply_pressure_Pa"})
    d.parameters.push_back({name, 1.0, std::nan(""), true});
  d.noise_floor_m = d.rms_after_m = 1e-4;
  d.steps = {{"", 5e-3}, {"friction", 0.98e-4}, {"backlash", 1e-4}};
  EXPECT_THAT(named(d), ElementsAre("backlash strained"));
  d.steps[1].validation_rms_m = 2e-4;
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, NothingIsEstablishedBesideALawThatOnlyComesNear) {
  Diagnosis d = unexplained();
  weigh_doubts(d);
  ASSERT_FALSE(d.established().empty());
  d.laws.emplace_back();
  d.laws.front().effect.name = "pendulum";
  weigh_doubts(d);
  EXPECT_THAT(d.established(), IsEmpty());
}

TEST(Confidence, WhereAnErrorRemainsASizeIsClearAtThreeStandardErrors) {
  Diagnosis d = unexplained();
  d.parameters[3].value = 2.5 * d.parameters[3].std_error;
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  d.verdict = Verdict::missing;
  EXPECT_THAT(named(d), IsEmpty());
  d.verdict = Verdict::unexplained;
  d.parameters[3].value = 3.5 * d.parameters[3].std_error;
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, ASizeAtItsBoundIsNotEstablished) {
  Diagnosis d = unexplained();
  d.parameters[1].at_bound = true;
  EXPECT_THAT(named(d), ElementsAre("friction at_bound", "backlash within_error"));
}

// Coulomb's level zero, the static one clear of its error: friction that fades with the speed.
TEST(Confidence, AnEffectWhoseRefinementIsClearIsEstablishedWithoutItsFirstSize) {
  Diagnosis d = unexplained();
  d.parameters[1] = {"friction.coulomb_N", 0.0, std::nan(""), true};
  EXPECT_THAT(named(d), ElementsAre("friction at_bound", "backlash within_error"));
  d.parameters[2] = {"friction.static_N", 11.4, 1.8, false};
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  // Coulomb's level not known, as the Stribeck speed is about the motion's own
  d.parameters[1] = {"friction.coulomb_N", 19.0, 10.0, false};
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  d.parameters[2] = {"friction.static_N", 21.0, 12.0, false};
  EXPECT_THAT(named(d), ElementsAre("friction within_error", "backlash within_error"));
}

TEST(Confidence, AClearDampingRatioDoesNotEstablishASecondMassWithinItsError) {
  Diagnosis d = unexplained();
  d.verdict = Verdict::missing;
  d.missing = {"friction", "second_mass"};
  d.parameters = {{"friction.coulomb_N", 150.0, 4.0, false},
                  {"second_mass.mass_ratio", 4.2e-4, 4.2e-4, false},
                  {"second_mass.resonance_Hz", 10.9, 0.02, false},
                  {"second_mass.damping_ratio", 0.007, 0.002, false}};
  EXPECT_THAT(named(d), ElementsAre("second_mass within_error"));
}

TEST(Confidence, AnEffectWithRivalsIsNotEstablished) {
  Diagnosis d = unexplained();
  d.ambiguous = {{"friction", "deadband"}};
  EXPECT_THAT(named(d), ElementsAre("friction rivals", "backlash within_error"));
  // another name of the same equation casts no doubt
  d.ambiguous.clear();
  d.same_here = {{"friction", "deadband"}};
  EXPECT_THAT(named(d), testing::Not(testing::Contains("friction rivals")));
}

// As a lasting offset in the place of an asymmetry, where either stops a free run from drifting.
TEST(Confidence, AnEffectThatADroppedOneOutdidIsNotEstablishedByAGainThatMayBeChance) {
  Diagnosis d = unexplained();
  d.without_rms_m["friction"] = 1.0;  // beyond doubt
  const auto tried = [](const char* effect, double left_m, double p_value) {
    Candidate one;
    one.effects = {effect};
    one.validation_rms_m = left_m;
    one.p_value = p_value;
    one.fitted_at_all = true;
    return one;
  };
  Round round;
  round.candidates = {tried("deadband", 1.2e-3, 5e-4), tried("friction", 1.4e-3, 9e-4)};
  Round next;
  next.before.added = {"deadband"};
  next.candidates = {tried("friction", 0.9e-3, 0.17)};
  d.search.rounds = {round, next};
  EXPECT_THAT(named(d), ElementsAre("friction chance", "backlash within_error"));

  const auto expect_established = [](const Diagnosis& other) {
    EXPECT_THAT(named(other), ElementsAre("backlash within_error"));
  };
  Diagnosis clear = d;
  clear.search.rounds[1].candidates[0].p_value = 0.001;
  expect_established(clear);
  Diagnosis level = d;
  level.search.rounds[0].candidates[0].validation_rms_m = 1.39e-3;
  expect_established(level);
  Diagnosis by_chance = d;
  by_chance.search.rounds[0].candidates[0].p_value = 0.2;
  expect_established(by_chance);
  Diagnosis not_tried = d;
  not_tried.search.rounds[0].candidates[0].fitted_at_all = false;
  expect_established(not_tried);
  Diagnosis in_model = d;
  in_model.search.rounds[0].candidates[0] = tried("backlash", 1.2e-3, 5e-4);
  in_model.search.rounds[1].before.added = {"backlash"};
  expect_established(in_model);
}

TEST(Confidence, ThreeEffectsThatLeaveAnErrorMayStandInForOneLaw) {
  Diagnosis d = unexplained();
  d.missing = {"friction", "load_spring", "load_force"};
  d.parameters.push_back({"load_force.force_N", 200.0, 5.0, false});
  d.parameters.push_back({"load_spring.stiffness_N_per_m", 2000.0, 30.0, false});
  EXPECT_THAT(named(d),
              ElementsAre("friction stand_in", "load_spring stand_in", "load_force stand_in"));
  EXPECT_THAT(d.established(), ElementsAre("friction", "load_spring", "load_force"));
  d.possible = possible_effects(d);
  EXPECT_THAT(d.established(), IsEmpty());
}

/// One effect that lets the error fall from `before_m` to 100 um, where the floor is 2 um.
Diagnosis with_friction(double before_m, const std::string& site_of_rest) {
  Diagnosis d = unexplained();
  d.missing = {"friction"};
  d.noise_floor_m = 2e-6;
  d.rms_after_m = 100e-6;
  d.steps = {{"", before_m}, {"friction", 100e-6}};
  d.where = {{site_of_rest, "speed", 0.9}};
  return d;
}

TEST(Confidence, AnEffectBesideWhichMuchRemainsIsNotEstablished) {
  EXPECT_THAT(named(with_friction(300e-6, "measurement")), ElementsAre("friction remainder"));
  EXPECT_THAT(named(with_friction(400e-6, "measurement")), IsEmpty());
}

TEST(Confidence, AnEffectThatEntersAsTheRestDoesIsEstablishedWhereLittleRemains) {
  EXPECT_THAT(named(with_friction(1.5e-3, "force")), ElementsAre("friction stand_in"));
  EXPECT_THAT(named(with_friction(1.5e-3, "measurement")), IsEmpty());
  EXPECT_THAT(named(with_friction(2.5e-3, "force")), IsEmpty());
  Diagnosis far = with_friction(2.5e-3, "force");
  far.noise_floor_m = 0.9e-6;  // 111 times that remains
  EXPECT_THAT(named(far), ElementsAre("friction stand_in"));
}

TEST(Confidence, AnEffectThatExplainedNearlyAllBeforeALawCameNearIsEstablished) {
  for (const auto& [before_m, doubted] : {std::pair{2.5e-3, 1U}, {1.5e-3, 2U}}) {
    Diagnosis d = with_friction(before_m, "force");
    d.missing.emplace_back("pendulum");
    d.laws.emplace_back();
    d.laws.front().effect.name = "pendulum";
    d.steps.push_back({"pendulum", 60e-6});
    d.rms_after_m = 60e-6;
    EXPECT_EQ(possible_effects(d).size(), doubted) << before_m;
    EXPECT_EQ(possible_effects(d).back().effect, "pendulum");
  }
  Diagnosis joint = with_friction(2.5e-3, "force");
  joint.missing = {"friction", "backlash", "pendulum"};
  joint.parameters[3].std_error = 1e-7;
  joint.laws.emplace_back();
  joint.laws.front().effect.name = "pendulum";
  joint.steps = {{"", 2.5e-3}, {"friction + backlash", 100e-6}, {"pendulum", 60e-6}};
  joint.rms_after_m = 60e-6;
  EXPECT_EQ(possible_effects(joint).size(), 3U) << "neither explains it alone";
  joint.steps = {{"", 2.5e-3}, {"friction", 300e-6}, {"backlash", 100e-6}, {"pendulum", 60e-6}};
  EXPECT_EQ(possible_effects(joint).size(), 3U) << "what came after it lowers what remains";
}

// The main site of a dead band is the valve's opening, whatever share an amplifier has of it.
TEST(Confidence, ADeadBandBesideARemainderOfTheFlowMayStandIn) {
  Diagnosis d = with_friction(1.5e-3, "flow");
  d.missing = {"deadband"};
  d.parameters = {{"deadband.half_width_V", 0.1, 1e-3, false}};
  d.steps.back().added = "deadband";
  EXPECT_THAT(named(d), ElementsAre("deadband stand_in"));
}

TEST(Confidence, AnEffectThatACurveElsewhereMatchesIsNotEstablished) {
  Diagnosis d = with_friction(2.5e-3, "force");
  d.rms_before_m = 2.5e-3;
  d.whole = {{"gain", "u", 0.999}};  // 0.001 is less than the 0.0016 that remain
  EXPECT_THAT(named(d), ElementsAre("friction stand_in"));
  d.whole = {{"gain", "u", 0.99}};
  EXPECT_THAT(named(d), IsEmpty());
  d.whole = {{"force", "v", 0.999}};
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, AFreeRunEstablishesNoEffectThatTheObserverHardlyShows) {
  Diagnosis d = with_friction(150e-6, "measurement");
  d.steps = {{"", 150e-6, 2e-3}, {"friction", 100e-6, 1e-4}};
  EXPECT_THAT(named(d), ElementsAre("friction remainder"));
  d.steps = {{"", 250e-6, 2e-3}, {"friction", 100e-6, 1e-4}};  // 5.25 times what remains
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, TheLikelihoodCountsWhereItDecided) {
  Diagnosis d = with_friction(120e-6, "measurement");
  d.innovations = 2000.0;
  d.curve_nats = 100.0;                 // a tenth of what is left
  d.gains_nats = {{"friction", 50.0}};  // another tenth
  EXPECT_THAT(named(d), ElementsAre("friction remainder"));
  d.gains_nats = {{"friction", 800.0}};
  d.by_innovations = true;
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, OfThreeThatExplainARecordThoseThatGainLittleAreNotEstablished) {
  Diagnosis d = unexplained();
  d.verdict = Verdict::missing;
  d.by_innovations = true;
  d.missing = {"friction", "load_spring", "load_force"};
  d.parameters = {{"friction.coulomb_N", 150.0, 4.0, false},
                  {"load_spring.stiffness_N_per_m", 2000.0, 30.0, false},
                  {"load_force.force_N", 200.0, 5.0, false}};
  d.innovations = 6000.0;
  d.curve_nats = 19.0;
  d.gains_nats = {{"friction", 1228.0}, {"load_spring", 47.0}, {"load_force", 26.0}};
  EXPECT_THAT(named(d), ElementsAre("load_spring stand_in", "load_force stand_in"));
  d.gains_nats = {{"friction", 1228.0}, {"load_spring", 470.0}, {"load_force", 260.0}};
  EXPECT_THAT(named(d), IsEmpty());
  // two effects are no bundle
  d.missing.pop_back();
  d.gains_nats = {{"friction", 1228.0}, {"load_spring", 47.0}};
  EXPECT_THAT(named(d), IsEmpty());
}

TEST(Confidence, WhereNoErrorRemainsWhatWasFoundStandsUnlessItsSizeIsWithinItsError) {
  Diagnosis d = unexplained();
  d.verdict = Verdict::missing;
  EXPECT_THAT(named(d), ElementsAre("backlash within_error"));
  d.parameters.back().std_error = 1e-6;
  EXPECT_THAT(possible_effects(d), IsEmpty());
}

}  // namespace
}  // namespace estimator::greybox::selection
