// Whole records: converters, repeatability, fineness of the step, and the plans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/truth/case.h"
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

/// Largest change of the reading when the step is halved, with the command given.
double change_m(const std::string& text) {
  const Case of = parse_case("length_s=6," + text, 3);
  const Record record = simulate(of);
  const int steps = of.hidden.coulomb_N > 0.0 ? 400 : 200;
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
  EXPECT_EQ(effects().size(), 19U);
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

}  // namespace
}  // namespace truth
