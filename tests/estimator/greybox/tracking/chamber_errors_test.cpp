// Chamber pressures beside command and position: what they tell, and when they are left out.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/estimator/greybox/tracking/tracked_rig.h"

namespace {

using namespace tracking_test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using truth::Plant;

constexpr double kNoise_Pa = 5e3;  // 0.05 % of a transducer of 100 bar
const std::vector<std::string>& with_gain() {
  static const std::vector<std::string> names{"supply_pressure_Pa", "damping_N_s_per_m",
                                              "valve_gain_m_per_V"};
  return names;
}

truth::Case sensed(double length_s, std::size_t seed = 1) {
  truth::Case of = stand(length_s, seed);
  of.pressure_noise_Pa = kNoise_Pa;
  return of;
}

TEST(Chambers, TellValveGainFromSupplyPressureWithoutAReadingOfTheSupply) {
  const std::pair<double Plant::*, const char*> faults[] = {
      {&Plant::valve_gain_m_per_V, "valve_gain_m_per_V"},
      {&Plant::supply_pressure_Pa, "supply_pressure_Pa"}};
  for (const auto& [member, name] : faults) {
    for (const double factor : {0.9, 1.1}) {
      truth::Case of = sensed(25.0);
      fault(of, 15.2, member, factor);
      const Tracked t = tracked(truth::simulate(of), with_gain());
      ASSERT_EQ(t.alarms.size(), 1u) << name;
      EXPECT_EQ(t.name(t.alarms[0]), name);
      EXPECT_THAT(t.alarms[0].named.rivals, IsEmpty());
      EXPECT_NEAR(std::exp(t.alarms[0].named.theta), factor, 0.01);
      EXPECT_LT(t.alarms[0].raised_s, 15.2 + 1.2);
    }
  }
}

TEST(Chambers, LeaveTheGroupWhereTheyAreNotRead) {
  truth::Case of = stand(25.0);
  fault(of, 15.2, &Plant::valve_gain_m_per_V, 0.9);
  const Tracked t = tracked(truth::simulate(of));
  ASSERT_EQ(t.alarms.size(), 1u);
  EXPECT_EQ(t.name(t.alarms[0]), "supply_pressure_Pa");
  ASSERT_EQ(t.alarms[0].named.rivals.size(), 1u);
  EXPECT_EQ(t.alarms[0].named.rivals[0].name, "valve_gain_m_per_V");
}

/// A transducer's reading from some time on.
using Failure = std::function<double(double right_Pa, double at_failure_Pa)>;

void fail(const truth::Record& record, std::vector<double>& readings_Pa, double at_s,
          const Failure& shown) {
  const auto first = static_cast<std::size_t>(std::lround(at_s / truth::kSample_s));
  const double at_failure_Pa = readings_Pa[first];
  for (std::size_t k = first; k < record.t_s.size(); ++k) {
    readings_Pa[k] = shown(readings_Pa[k], at_failure_Pa);
  }
}

const std::pair<const char*, Failure> kFailures[] = {
    {"frozen", [](double, double held_Pa) { return held_Pa; }},
    {"offset", [](double right_Pa, double) { return right_Pa + 5e5; }},
    {"low by twice its value", [](double right_Pa, double) { return 0.5 * right_Pa; }},
    {"off scale", [](double, double) { return 1e7; }},
    {"dead", [](double, double) { return 0.0; }},
    {"not read", [](double, double) { return NAN; }},
};

TEST(Chambers, OfAFailedTransducerAreLeftOutWithAReasonAndNameNothing) {
  for (const auto& [what, failure] : kFailures) {
    for (const bool in : {true, false}) {
      truth::Record record = truth::simulate(sensed(24.0));
      fail(record, in ? record.in_Pa : record.out_Pa, 14.3, failure);
      const Tracked t = tracked(record, with_gain());
      EXPECT_THAT(t.alarms, IsEmpty()) << what << " " << t.name(t.alarms[0]);
      for (const iso::WindowResult& window : t.windows) {
        const bool right = window.t_s < 14.3;
        EXPECT_EQ(!window.left_out, right || !window.fits) << what << " " << window.t_s;
        if (window.from_s < 14.3) continue;
        EXPECT_TRUE(window.fits) << what << " " << window.t_s << " "
                                 << tracker::invalid_words(t.set, window.invalid);
        if (std::string(what) != "not read") {
          EXPECT_THAT(tracker::left_out_words(window.left_out),
                      HasSubstr(in ? "pressure in" : "pressure out"))
              << what;
        }
        // Damping goes on by position alone; supply pressure and valve gain are one number then.
        EXPECT_TRUE(window.estimates[1].valid)
            << what << " " << tracker::invalid_words(t.set, window.estimates[1].invalid);
        EXPECT_NEAR(window.estimates[1].value, 1000.0, 50.0) << what;
        EXPECT_FALSE(window.estimates[2].valid) << what;
      }
    }
  }
}

TEST(Chambers, OfAFailedTransducerLeaveTheGroupAndTheDampingToThePosition) {
  const std::pair<double Plant::*, const char*> faults[] = {
      {&Plant::valve_gain_m_per_V, "supply_pressure_Pa"},
      {&Plant::supply_pressure_Pa, "supply_pressure_Pa"},
      {&Plant::damping_N_s_per_m, "damping_N_s_per_m"}};
  for (const auto& [member, name] : faults) {
    truth::Case of = sensed(28.0);
    fault(of, 20.0, member, 1.25);
    truth::Record record = truth::simulate(of);
    fail(record, record.in_Pa, 12.0, kFailures[1].second);
    const Tracked t = tracked(record, with_gain());
    ASSERT_EQ(t.alarms.size(), 1u) << name;
    EXPECT_EQ(t.name(t.alarms[0]), name);
    const auto& rivals = t.alarms[0].named.rivals;
    const bool gain = std::any_of(rivals.begin(), rivals.end(), [](const iso::Rival& rival) {
      return rival.name == "valve_gain_m_per_V";
    });
    EXPECT_EQ(gain, std::string(name) == "supply_pressure_Pa") << name;
  }
}

/// Standard errors of the tracked parameters over the window's own value, in a healthy record.
std::vector<double> errors_of(const truth::Record& record, const std::vector<std::string>& names,
                              const plant_sim::ModelFile& model) {
  iso::TrackerSettings settings;
  settings.fused = 1;
  const Tracked t = tracked(record, names, settings, model);
  EXPECT_THAT(t.alarms, IsEmpty());
  std::vector<double> mean(names.size(), 0.0);
  for (const iso::WindowResult& window : t.windows) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const iso::ParameterEstimate& one = window.estimates[i];
      mean[i] += one.std_error / one.value / static_cast<double>(t.windows.size());
    }
  }
  return mean;
}

TEST(Chambers, MakeDampingFrictionAndMassBetterKnown) {
  const std::pair<const char*, double> expected[] = {
      {"damping_N_s_per_m", 0.6}, {"friction.coulomb_N", 0.6}, {"mass_kg", 0.85}};
  for (const auto& [name, most_ratio] : expected) {
    truth::Case of = sensed(30.0);
    plant_sim::ModelFile model = printed_model();
    if (std::string(name) == "friction.coulomb_N") {
      of.hidden.coulomb_N = 100.0;
      *model.value("friction.coulomb_N") = 100.0;
    }
    truth::Record record = truth::simulate(of);
    const double with = errors_of(record, {"supply_pressure_Pa", name}, model)[1];
    record.in_Pa.clear();
    record.out_Pa.clear();
    const double without = errors_of(record, {"supply_pressure_Pa", name}, model)[1];
    std::printf("  %s: standard error %.2f %% by position, %.2f %% with chamber pressures\n", name,
                100.0 * without, 100.0 * with);
    EXPECT_LT(with, most_ratio * without) << name;
  }
}

TEST(Chambers, HaveEstimatesWithinTheirStandardErrors) {
  double squares = 0.0;
  int count = 0;
  for (const std::size_t seed : {1, 2, 3, 4}) {
    truth::Case of = sensed(40.0, seed);
    of.plant.damping_N_s_per_m *= 1.25;
    iso::TrackerSettings settings;
    settings.fused = 1;
    const Tracked t = tracked(truth::simulate(of), with_gain(), settings);
    for (std::size_t i = 0; i < t.windows.size(); i += 6) {  // that have no window in common
      const iso::ParameterEstimate& damping = t.windows[i].estimates[1];
      squares += std::pow((damping.value - of.plant.damping_N_s_per_m) / damping.std_error, 2);
      ++count;
    }
  }
  // The mean of about 50 squares of normal numbers, four standard deviations to either side.
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST(Chambers, NameNothingWhileTheRigIsHealthy) {
  for (const std::size_t seed : {1, 2, 3}) {
    for (const char* motion : {"sine", "multisine"}) {
      truth::Case of = sensed(120.0, seed);
      of.motion = motion;
      const Tracked t = tracked(truth::simulate(of), with_gain());
      EXPECT_THAT(t.alarms, IsEmpty()) << motion << " " << seed;
      int left_out = 0;
      for (const iso::WindowResult& window : t.windows) left_out += window.left_out ? 1 : 0;
      EXPECT_EQ(left_out, 0) << motion << " " << seed;
    }
  }
}

TEST(Chambers, CountAnOffsetByItsOwnAndTheNoisesVariance) {
  const truth::Record record = truth::simulate(sensed(3.0));
  const plant_sim::ModelFile model = printed_model();
  const iso::ParameterSet set = iso::choose(model, usual(), "parameters");
  constexpr std::size_t kLead = 150;
  constexpr std::size_t kSamples = 400;
  iso::WindowFit fit(model, set.parameters, truth::kSample_s, kLead + kSamples);
  iso::WindowData data{record.u_V.data(), record.y_m.data(), kLead, kSamples};
  data.in_Pa = record.in_Pa.data();
  data.out_Pa = record.out_Pa.data();
  const iso::ErrorScales errors{kFloor_m, {{5e3, 0.0, 5e3}, {6e3, 0.0, 6e3}, 2e3}};
  const iso::WindowFitSummary before = fit.fit(data, {}, set.file, errors);
  std::vector<double> off_Pa = record.in_Pa;
  for (double& value : off_Pa) value += 3e4;
  data.in_Pa = off_Pa.data();
  const iso::WindowFitSummary after = fit.fit(data, {}, set.file, errors);
  EXPECT_NEAR(after.in.mean_Pa - before.in.mean_Pa, 3e4, 1e-3);
  EXPECT_NEAR(after.in.rms_Pa, before.in.rms_Pa, 1e-6);
  EXPECT_NEAR(after.out.mean_Pa, before.out.mean_Pa, 1e-6);
  // A mean of n readings has the variance sigma^2 / n + S^2.
  const double variance_Pa2 = 5e3 * 5e3 / kSamples + 2e3 * 2e3;
  const double more =
      (std::pow(after.in.mean_Pa, 2) - std::pow(before.in.mean_Pa, 2)) / variance_Pa2;
  EXPECT_NEAR(after.chi_square - before.chi_square, more, 1e-6 * more);
}

TEST(Chambers, AreNotAskedForWhereTheyAreRead) {
  const iso::ParameterSet set = iso::choose(printed_model(), usual(), "parameters");
  iso::ParameterChange named{
      1, 0.1, 0.01, 0.1, {{"internal_leakage.conductance_m3ps_per_Pa", 1e-12}}, {}};
  EXPECT_EQ(tracker::advice_words(set, named), "a reading of the chamber pressures would");
  EXPECT_THAT(tracker::group_words(set, named), HasSubstr(": command and position cannot tell"));
  named.sensed.chambers = true;
  EXPECT_EQ(tracker::advice_words(set, named),
            "a motion of other speeds and accelerations would");  // damping
  EXPECT_THAT(tracker::group_words(set, named),
              HasSubstr("command, position and chamber pressures cannot tell"));
  named.rivals = {{"supply_droop.droop_Pa_per_m3ps", 1e10}};
  EXPECT_EQ(tracker::advice_words(set, named), "a reading of the supply pressure would");
  named.sensed.supply = true;
  EXPECT_THAT(tracker::advice_words(set, named), Not(HasSubstr("supply")));
}

}  // namespace
