// Whole records: converters, repeatability, fineness of the step, and the plans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/truth/case.h"
#include "tests/truth/model_files.h"
#include "tests/truth/plan.h"
#include "tests/truth/visibility.h"

namespace truth {
namespace {

const std::string kAll =
    "transport_delay.delay_s=0.004,null_bias.offset_V=0.07,valve_hysteresis.half_width_V=0.1,"
    "spool_rate_limit.rate_mps=3e-4,deadband.half_width_V=0.2,flow_asymmetry.asymmetry_ratio=0.04,"
    "flow_saturation.limit_m3ps=6e-5,supply_droop.droop_Pa_per_m3ps=1e10,"
    "internal_leakage.conductance_m3ps_per_Pa=1.4e-11,"
    "external_leakage.conductance_m3ps_per_Pa=2e-13,entrained_air.fraction_ratio=0.05,"
    "friction.coulomb_N=150,friction.static_N=190,quadratic_damping.coefficient_N_s2_per_m2=1e4,"
    "load_spring.stiffness_N_per_m=5000,load_force.force_N=100,force_ripple.amplitude_N=100,"
    "coupled_slaves.mass_kg=20,backlash.width_m=8e-5,encoder_eccentricity.amplitude_m=4e-5";

TEST(TruthRecord, IsQuantisedAndStartsAtRest) {
  const Record record = simulate(parse_case("motion=multisine,length_s=4", 5));
  ASSERT_EQ(record.t_s.size(), 800U);
  EXPECT_NEAR(record.y_m.front(), 0.305, 1e-5);
  for (std::size_t k = 0; k < record.t_s.size(); ++k) {
    const double codes = record.u_V[k] / (20.0 / 4096.0);
    const double counts = record.y_m[k] / 5e-6;
    EXPECT_NEAR(codes, std::round(codes), 1e-9);
    EXPECT_NEAR(counts, std::round(counts), 1e-6);
    EXPECT_LE(std::abs(record.u_V[k]), 10.0);
  }
  // Noise of 2 um and rounding to 5 um: sqrt(4 + 25/12) um.
  EXPECT_NEAR(record.floor_m, 2.466e-6, 0.15e-6);
}

TEST(TruthRecord, ComesOutTheSameFromItsOwnText) {
  const Case first = parse_case("motion=fast_steps,mismatched=1,length_s=3," + kAll, 7);
  const Case again = parse_case(to_text(first), 7);
  const Record a = simulate(again);
  const Record b = simulate(parse_case(to_text(again), 7));
  EXPECT_EQ(a.y_m, b.y_m);
  EXPECT_EQ(a.u_V, b.u_V);
  EXPECT_NE(a.y_m, simulate(parse_case(to_text(again), 8)).y_m);
}

TEST(TruthRecord, OfAnotherRigComesOutTheSameFromItsOwnText) {
  for (const char* rig : {"linear_axis", "rotary_axis", "single_rod"}) {
    const Case first = parse_case(
        std::string("rig=") + rig +
            ",motion=chirp,length_s=3,sample_s=0.01,log_every=2,period_s=1.5,ki_V_per_m_s=3,"
            "transport_delay.delay_s=0.004,friction.coulomb_N=0.1,outside.force_N=0.2,"
            "outside.line_N=0.3,outside.line_Hz=21",
        7);
    const std::string text = to_text(first);
    EXPECT_EQ(to_text(parse_case(text, 7)), text);
    // Another seed draws another plant, which the text then sets back.
    EXPECT_NE(to_text(parse_case(std::string("rig=") + rig, 8)),
              to_text(parse_case(std::string("rig=") + rig, 7)));
    const Record a = simulate(parse_case(text, 7));
    const Record b = simulate(parse_case(text, 7));
    EXPECT_EQ(a.y_m, b.y_m);
    EXPECT_EQ(a.u_V, b.u_V);
    EXPECT_NE(a.y_m, simulate(parse_case(text, 8)).y_m);
  }
  EXPECT_THROW(parse_case("rig=crane", 1), std::invalid_argument);
  EXPECT_THROW(parse_case("rig=linear_axis,plant.bulk_modulus_Pa=1e9", 1), std::invalid_argument);
}

/// Largest change of the reading when the step is halved, with the command given.
double change_m(const std::string& text) {
  const Case of = parse_case("length_s=6," + text, 3);
  const Record record = simulate(of);
  const int steps = machine(of)->steps();
  const auto coarse = replay(of, record.u_V, steps);
  const auto fine = replay(of, record.u_V, 2 * steps);
  double most_m = 0.0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    most_m = std::max(most_m, std::abs(fine[k] - coarse[k]));
  }
  return most_m;
}

TEST(TruthRecord, ChangesByUnderATenthOfAMicrometreWhenTheStepIsHalved) {
  constexpr double kFine_m = 1e-7;
  for (const char* motion : {"multisine", "fast_steps", "slow_steps", "sine"}) {
    EXPECT_LT(change_m(std::string("motion=") + motion), kFine_m) << motion;
  }
  std::string words = kAll;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t comma = std::min(words.find(',', at), words.size());
    const std::string one = words.substr(at, comma - at);
    EXPECT_LT(change_m("motion=multisine," + one), kFine_m) << one;
    at = comma + 1;
  }
  for (const LeftOutInfo& info : left_out_table()) {
    EXPECT_LT(change_m("motion=multisine,left_out=" + info.name), kFine_m) << info.name;
  }
}

TEST(TruthRecord, OfAnotherRigChangesByUnderATenthOfItsNoiseWhenTheStepIsHalved) {
  const std::string linear = "rig=linear_axis,motion=multisine,";
  for (const char* words :
       {"friction.coulomb_N=20,friction.static_N=28,friction.bristle_N_s_per_m=2000",
        "friction.coulomb_N=20,friction.presliding_stiffness_N_per_m=3e5",
        "friction.coulomb_N=20,friction.bristle_N_s_per_m=2000,friction.damping_speed_mps=0.01",
        "force_ripple.amplitude_N=12,force_ripple.wavelength_m=0.016",
        "force_ripple.amplitude_N=12,force_ripple.wavelength_m=0.016,force_ripple.second_sin_N=3",
        "load_spring.stiffness_N_per_m=300,backlash.width_m=1e-4", "transport_delay.delay_s=0.0063",
        "quadratic_damping.coefficient_N_s2_per_m2=400,load_force.force_N=8",
        "left_out=elastic_shaft"}) {
    EXPECT_LT(change_m(linear + words), 1e-7) << words;
  }
  for (const char* words : {"deadband.half_width_V=0.4,supply_droop.droop_Pa_per_m3ps=1.5e10",
                            "valve_hysteresis.half_width_V=0.2,null_bias.offset_V=0.15",
                            "friction.coulomb_N=300,friction.static_N=400"}) {
    EXPECT_LT(change_m(std::string("rig=single_rod,motion=multisine,") + words), 2e-7) << words;
  }
}

TEST(TruthRecord, RefusesUnknownWords) {
  EXPECT_THROW(parse_case("motion=dance", 1), std::invalid_argument);
  EXPECT_THROW(parse_case("friction.coulomb=3", 1), std::invalid_argument);
  EXPECT_THROW(parse_case("left_out=nothing", 1), std::invalid_argument);
  EXPECT_THROW(parse_case("friction.coulomb_N=much", 1), std::invalid_argument);
}

TEST(TruthVisibility, IsOneForAHealthyRecordAndFarAboveForAPlainEffect) {
  const Case healthy = parse_case("motion=multisine,length_s=10", 2);
  EXPECT_NEAR(visibility_ratio(healthy, simulate(healthy)), 1.0, 0.05);
  const Case biased = parse_case("motion=multisine,length_s=10,null_bias.offset_V=0.07", 2);
  EXPECT_GT(visibility_ratio(healthy, simulate(biased)), 20.0);
}

TEST(TruthPlan, HidesAsManyEffectsAsThePlanSays) {
  EXPECT_EQ(effects().size(), 21U);
  EXPECT_GE(left_out_table().size(), 6U);
  Record record;
  const Planned single = plan_record("single", 1, 1, record);
  EXPECT_EQ(single.hidden, std::vector<std::string>{"null_bias"});
  EXPECT_GT(single.visibility.front(), 1.5);
  EXPECT_TRUE(plan_record("healthy", 1, 0, record).hidden.empty());
  EXPECT_EQ(plan_record("pairs", 1, 0, record).hidden.size(), 2U);
  const Planned left = plan_record("leftout", 1, 0, record);
  EXPECT_TRUE(left.hidden.empty());
  EXPECT_NE(left.of.left_out.kind, LeftOut::Kind::none);
  EXPECT_THROW(plan_record("other", 1, 0, record), std::invalid_argument);
}

TEST(TruthPlan, AnswersWithoutTheValuesThatAreInfinite) {
  Record record;
  const Planned friction = plan_record("axes", 1, 0, record);
  const std::string file = testing::TempDir() + "truth_answers.json";
  write_answers(file, "axes", 1, {friction}, {1e-6});
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_NE(text.str().find("\"coulomb_N\": "), std::string::npos);
  EXPECT_EQ(text.str().find("inf"), std::string::npos) << text.str();
  std::remove(file.c_str());
}

TEST(TruthPlan, TakesAxesByTurnsLinearAndRotaryUndisturbedAndDisturbed) {
  Record record;
  const Planned linear = plan_record("axes", 1, 0, record);
  EXPECT_EQ(linear.of.kind, Kind::linear_axis);
  EXPECT_EQ(linear.hidden, std::vector<std::string>{"friction"});
  EXPECT_FALSE(linear.of.outside.any());
  const Planned rotary = plan_record("axes", 1, 13, record);
  EXPECT_EQ(rotary.of.kind, Kind::rotary_axis);
  EXPECT_EQ(rotary.hidden, std::vector<std::string>{"force_ripple"});
  EXPECT_TRUE(rotary.of.outside.any());
  EXPECT_EQ(plan_record("axes", 1, 11, record).hidden.size(), 2U);
  EXPECT_EQ(plan_record("axes", 1, 35, record).of.left_out.kind, LeftOut::Kind::elastic_shaft);
  EXPECT_EQ(plan_record("axes", 1, 83, record).hidden,
            std::vector<std::string>{"drive_saturation"});
  EXPECT_EQ(plan_record("axes", 1, 95, record).hidden, std::vector<std::string>{"drive_lag"});
}

TEST(TruthPlan, CallsACylindersAreasAnAsymmetryAndListsWhatAServoHasNoPlaceFor) {
  Record record;
  const Planned uneven = plan_record("single_rods", 1, 3, record);
  EXPECT_EQ(uneven.hidden, (std::vector<std::string>{"deadband", "flow_asymmetry"}));
  EXPECT_EQ(unshown_effects(uneven.of), std::vector<std::string>{"supply_droop"});
  EXPECT_LT(uneven.of.rod.area_rod_m2, 0.8 * uneven.of.rod.area_cap_m2);
  EXPECT_TRUE(plan_record("single_rods", 1, 7, record).hidden.empty());
}

TEST(TruthPlan, GoesThroughConditionsLawsMismatchAndRepetition) {
  Record record;
  EXPECT_EQ(plan_record("conditions", 1, 1, record).condition, "100Hz");
  EXPECT_EQ(record.t_s.size(), 3000U);
  const Planned outside = plan_record("outside_laws", 1, 0, record);
  EXPECT_NE(outside.of.left_out.kind, LeftOut::Kind::none);
  EXPECT_TRUE(outside.of.outside.any());
  const Planned again = plan_record("repeated", 1, 0, record);
  EXPECT_GT(again.of.period_s, 0.0);
  EXPECT_TRUE(again.of.outside.any());
  Case off;
  draw_plant_within(off, 0.2);
  const Plant printed;
  EXPECT_GT(std::abs(off.plant.mass_kg - printed.mass_kg), 0.0);
  EXPECT_LE(std::abs(off.plant.mass_kg - printed.mass_kg), 0.2 * printed.mass_kg);
  EXPECT_NE(plan_record("mismatch20", 1, 1, record).of.plant.mass_kg, printed.mass_kg);
}

TEST(TruthPlan, WritesTheModelFilesAtThePrintedValues) {
  EXPECT_EQ(model_name(Kind::actuator), "");
  EXPECT_EQ(model_name(Kind::rotary_axis), "rotary_axis.toml");
  EXPECT_NE(model_text(Kind::rotary_axis).find("mass_kg = 0.05\n"), std::string::npos);
  EXPECT_NE(model_text(Kind::linear_axis).find("plant = \"force_driven_axis\""), std::string::npos);
  EXPECT_NE(model_text(Kind::single_rod).find("plant = \"velocity_servo\""), std::string::npos);
}

}  // namespace
}  // namespace truth
