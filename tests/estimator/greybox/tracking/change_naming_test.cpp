// The source's cases, and those that it could not tell apart.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using truth::Plant;

constexpr double kOnTimePressure_s = 1.2;
constexpr double kOnTimeDamping_s = 3.0;

/// Has an alarm for the parameter, in that direction, raised within the delay after at_s.
bool names(const Tracked& t, const std::string& parameter, int direction, double at_s,
           double delay_s) {
  return std::any_of(t.alarms.begin(), t.alarms.end(), [&](const iso::DetectedChange& alarm) {
    return t.name(alarm) == parameter && alarm.named.deviation * direction > 0.0 &&
           alarm.raised_s >= at_s && alarm.raised_s < at_s + delay_s;
  });
}

bool has_rival(const iso::DetectedChange& alarm, const std::string& name) {
  const auto& rivals = alarm.named.rivals;
  return std::any_of(rivals.begin(), rivals.end(),
                     [&](const iso::Rival& rival) { return rival.name == name; });
}

TEST(Isolation, NamesTheSupplyPressureAndNothingElseInCaseOne) {
  truth::Case of = stand(60.0);
  fault(of, 15.0, &Plant::supply_pressure_Pa, 1.25);
  fault(of, 30.0, &Plant::supply_pressure_Pa, 1.0);
  fault(of, 45.0, &Plant::supply_pressure_Pa, 0.75);
  const Tracked t = tracked(truth::simulate(of));
  ASSERT_EQ(t.alarms.size(), 2u);
  EXPECT_TRUE(names(t, "supply_pressure_Pa", 1, 15.0, kOnTimePressure_s));
  EXPECT_TRUE(names(t, "supply_pressure_Pa", -1, 45.0, kOnTimePressure_s));
  EXPECT_GT(t.alarms[0].cleared_s, 30.0);
  EXPECT_LT(t.alarms[0].cleared_s, 33.0);
  EXPECT_TRUE(t.alarms[1].active());
  EXPECT_NEAR(std::exp(t.alarms[0].named.theta), 1.25, 0.0025);
  EXPECT_NEAR(std::exp(t.alarms[1].named.theta), 0.75, 0.0015);
}

TEST(Isolation, NamesTheDampingAndNothingElseInCaseTwo) {
  truth::Case of = stand(60.0);
  fault(of, 15.0, &Plant::damping_N_s_per_m, 1.25);
  fault(of, 30.0, &Plant::damping_N_s_per_m, 1.0);
  fault(of, 45.0, &Plant::damping_N_s_per_m, 0.75);
  const Tracked t = tracked(truth::simulate(of));
  ASSERT_EQ(t.alarms.size(), 2u);
  EXPECT_TRUE(names(t, "damping_N_s_per_m", 1, 15.0, kOnTimeDamping_s));
  EXPECT_TRUE(names(t, "damping_N_s_per_m", -1, 45.0, kOnTimeDamping_s));
  EXPECT_NEAR(std::exp(t.alarms[0].named.theta), 1.25, 0.03 * 1.25);
  EXPECT_NEAR(std::exp(t.alarms[1].named.theta), 0.75, 0.03 * 0.75);
}

TEST(Isolation, TellsTheTwoApartInCaseThreeAloneAndTogether) {
  truth::Case of = stand(75.0);
  fault(of, 15.0, &Plant::damping_N_s_per_m, 1.25);
  fault(of, 30.0, &Plant::damping_N_s_per_m, 1.0);
  fault(of, 45.0, &Plant::supply_pressure_Pa, 1.1);
  fault(of, 60.0, &Plant::damping_N_s_per_m, 0.9);
  const Tracked t = tracked(truth::simulate(of));
  ASSERT_EQ(t.alarms.size(), 3u);
  EXPECT_TRUE(names(t, "damping_N_s_per_m", 1, 15.0, kOnTimeDamping_s));
  EXPECT_TRUE(names(t, "supply_pressure_Pa", 1, 45.0, kOnTimePressure_s));
  EXPECT_TRUE(names(t, "damping_N_s_per_m", -1, 60.0, kOnTimeDamping_s));
}

TEST(Isolation, TellsEqualChangesOfBothFromOneOfTheValve) {
  truth::Case of = stand(25.0);
  fault(of, 15.2, &Plant::supply_pressure_Pa, 1.1);
  fault(of, 15.2, &Plant::damping_N_s_per_m, 1.1);
  const Tracked t = tracked(truth::simulate(of));
  EXPECT_EQ(t.alarms.size(), 2u);
  EXPECT_TRUE(names(t, "supply_pressure_Pa", 1, 15.2, kOnTimePressure_s));
  EXPECT_TRUE(names(t, "damping_N_s_per_m", 1, 15.2, 5.0));
}

TEST(Isolation, GivesTheGroupOfPressureAndValveGainWhenTheValveGainChanges) {
  for (const double factor : {1.05, 0.9}) {
    truth::Case of = stand(25.0);
    fault(of, 15.2, &Plant::valve_gain_m_per_V, factor);
    const Tracked t = tracked(truth::simulate(of));
    ASSERT_EQ(t.alarms.size(), 1u) << factor;
    EXPECT_EQ(t.name(t.alarms[0]), "supply_pressure_Pa");
    ASSERT_EQ(t.alarms[0].named.rivals.size(), 1u);
    const iso::Rival& rival = t.alarms[0].named.rivals[0];
    EXPECT_EQ(rival.name, "valve_gain_m_per_V");
    EXPECT_NEAR(rival.value, factor * of.plant.valve_gain_m_per_V, 1e-3 * rival.value);
  }
}

TEST(Isolation, SaysThatTheValveGainWouldExplainAChangeOfPressureAsWell) {
  for (const double factor : {1.25, 0.9}) {
    truth::Case of = stand(25.0);
    fault(of, 15.2, &Plant::supply_pressure_Pa, factor);
    const Tracked t = tracked(truth::simulate(of));
    ASSERT_EQ(t.alarms.size(), 1u) << factor;
    EXPECT_TRUE(has_rival(t.alarms[0], "valve_gain_m_per_V")) << factor;
  }
}

TEST(Isolation, GivesTheMassAndTheSquareLawInTheGroupOfADampingThatTheyLookLike) {
  truth::Case heavier = stand(25.0);
  fault(heavier, 15.2, &Plant::mass_kg, 1.2);
  truth::Case rougher = stand(25.0);
  rougher.changes.push_back({15.2, nullptr, &truth::Hidden::quadratic_N_s2_per_m2, 2000.0});
  const std::pair<truth::Case, const char*> cases[] = {
      {heavier, "mass_kg"}, {rougher, "quadratic_damping.coefficient_N_s2_per_m2"}};
  for (const auto& [of, name] : cases) {
    const Tracked t = tracked(truth::simulate(of));
    ASSERT_EQ(t.alarms.size(), 1u) << name;
    EXPECT_EQ(t.name(t.alarms[0]), "damping_N_s_per_m");
    EXPECT_TRUE(has_rival(t.alarms[0], name)) << name;
  }
}

TEST(Isolation, SeparatesTheNeedleValveThatIsClosedByFourFifths) {
  // The slaves as config/models/rig_2000psi_slaves.toml assumes them; the instruments of the rig.
  truth::Case of = stand(40.0);
  of.plant.supply_pressure_Pa = 13.79e6;
  of.plant.valve_gain_m_per_V = 1.14011e-5;
  of.kp_V_per_m = 600.0;
  of.encoder_m = 2.5e-6;
  of.noise_m = 0.2e-6;
  of.hidden.slaves_kg = 20.0;
  of.hidden.slaves_N_s_per_m = 2000.0;
  of.hidden.needle_N_s2_per_m2 = 20.0;
  of.changes.push_back({20.0, nullptr, &truth::Hidden::needle_N_s2_per_m2, 500.0});
  plant_sim::ModelFile model = printed_model();
  *model.value("supply_pressure_Pa") = of.plant.supply_pressure_Pa;
  *model.value("valve_gain_m_per_V") = of.plant.valve_gain_m_per_V;
  *model.value("coupled_slaves.mass_kg") = 20.0;
  *model.value("coupled_slaves.damping_N_s_per_m") = 2000.0;
  *model.value("coupled_slaves.needle_N_s2_per_m2") = 20.0;
  const Tracked t =
      tracked(truth::simulate(of), {"supply_pressure_Pa", "coupled_slaves.needle_N_s2_per_m2"}, {},
              model, 0.75e-6);
  ASSERT_EQ(t.alarms.size(), 1u);
  EXPECT_EQ(t.name(t.alarms[0]), "coupled_slaves.needle_N_s2_per_m2");
  const auto& p = t.set.parameters[t.alarms[0].named.parameter];
  const double needle = p.to_physical(t.alarms[0].named.theta);
  EXPECT_NEAR(needle, 500.0, 5.0 * t.alarms[0].named.std_error * p.slope(t.alarms[0].named.theta));
  EXPECT_NEAR(needle, 500.0, 100.0);
}

TEST(Isolation, TellsValveGainFromSupplyPressureWithAReadingOfThePressure) {
  const std::vector<std::string> names{"supply_pressure_Pa", "damping_N_s_per_m",
                                       "valve_gain_m_per_V"};
  const std::pair<double Plant::*, const char*> faults[] = {
      {&Plant::valve_gain_m_per_V, "valve_gain_m_per_V"},
      {&Plant::supply_pressure_Pa, "supply_pressure_Pa"}};
  for (const auto& [member, name] : faults) {
    truth::Case of = stand(25.0);
    fault(of, 15.2, member, 0.9);
    const truth::Record record = truth::simulate(of);
    truth::Random random(3);
    std::vector<double> supply_Pa;
    for (const double t_s : record.t_s) {
      const bool low = t_s >= 15.2 && member == &Plant::supply_pressure_Pa;
      supply_Pa.push_back((low ? 0.9 : 1.0) * 6.89e6 + 2e4 * random.normal());
    }
    const Tracked t = tracked(record, names, {}, printed_model(), kFloor_m, supply_Pa);
    ASSERT_EQ(t.alarms.size(), 1u) << name;
    EXPECT_EQ(t.name(t.alarms[0]), name);
    EXPECT_TRUE(t.alarms[0].named.rivals.empty() || !has_rival(t.alarms[0], "supply_pressure_Pa"));
    EXPECT_FALSE(has_rival(t.alarms[0], "valve_gain_m_per_V"));
    EXPECT_NEAR(std::exp(t.alarms[0].named.theta), 0.9, 0.002);
  }
}

TEST(Isolation, NamesNothingWhileTheRigIsHealthy) {
  for (const std::size_t seed : {1, 2, 3}) {
    EXPECT_TRUE(tracked(truth::simulate(stand(60.0, seed))).alarms.empty()) << seed;
  }
}

TEST(Isolation, TracksOtherParametersThatAreAskedFor) {
  truth::Case of = stand(25.0);
  of.changes.push_back({15.2, nullptr, &truth::Hidden::null_bias_V, 0.05});
  const Tracked t = tracked(truth::simulate(of), {"supply_pressure_Pa", "null_bias.offset_V"});
  ASSERT_EQ(t.alarms.size(), 1u);
  EXPECT_EQ(t.name(t.alarms[0]), "null_bias.offset_V");
  const auto& p = t.set.parameters[t.alarms[0].named.parameter];
  EXPECT_NEAR(p.to_physical(t.alarms[0].named.theta), 0.05, 0.0005);
}

}  // namespace
