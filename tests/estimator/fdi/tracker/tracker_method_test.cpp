// The tracker in a pipeline: its alarms by name, its values, and its state carried bit for bit.
#include "config/schema/document.h"
#include "estimator/fdi/snapshot.h"
#include "estimator/fdi/tracker/tracker_config.h"
#include "tests/estimator/greybox/tracking/tracked_rig.h"

#include <gmock/gmock.h>

namespace tracker = estimator::fdi::tracker;

namespace {

using namespace tracking_test;
namespace fdi = estimator::fdi;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kLearn_s = 6.0;

struct Log final : fdi::Events {
  struct Change {
    double t_s;
    fdi::Alarm alarm;
  };
  std::vector<Change> alarms;
  std::vector<std::vector<double>> values;
  std::vector<std::string> reasons;
  int warming_up = 0;

  void on_estimate(const fdi::EstimateEvent& event) override {
    warming_up += event.warming_up ? 1 : 0;
    reasons.emplace_back(event.reason);
    values.emplace_back();
    for (const fdi::EstimatedValue& value : event) {
      values.back().push_back(value.value);
      values.back().push_back(value.std_error);
    }
  }
  void on_alarm(const fdi::Alarm& alarm) override {
    alarms.push_back({static_cast<double>(alarm.tick) * truth::kSample_s, alarm});
  }
};

fdi::PipelineConfig watching(std::vector<std::string> parameters = usual()) {
  fdi::PipelineConfig config(tracker::detection_method_kinds());
  auto tracker = std::make_unique<tracker::TrackerConfig>();
  tracker->id = "physics";
  tracker->model_toml = plant_sim::print_model(printed_model());
  tracker->parameters = std::move(parameters);
  tracker->learn_s = kLearn_s;
  config.add("tracker", std::move(tracker));
  return config;
}

void run(fdi::Pipeline& pipeline, const truth::Record& record, std::size_t from, std::size_t to,
         Log& log) {
  for (std::size_t k = from; k < to; ++k) {
    config::signals::Sample sample;
    sample.tick = static_cast<std::int64_t>(k);
    sample.u_applied_V = record.u_V[k];
    sample.y_m = record.y_m[k];
    if (!record.in_Pa.empty()) sample.pressures.in_Pa = record.in_Pa[k];
    if (!record.out_Pa.empty()) sample.pressures.out_Pa = record.out_Pa[k];
    if (!record.supply_Pa.empty()) sample.pressures.supply_Pa = record.supply_Pa[k];
    pipeline.process(sample, log);
  }
}

truth::Record case_three() {
  truth::Case of = stand(30.0);
  fault(of, 12.0, &truth::Plant::damping_N_s_per_m, 1.25);
  fault(of, 18.0, &truth::Plant::damping_N_s_per_m, 1.0);
  fault(of, 24.0, &truth::Plant::supply_pressure_Pa, 1.1);
  return truth::simulate(of);
}

TEST(TrackerMethod, TellsDampingAndSupplyPressureApartOnLine) {
  const truth::Record record = case_three();
  fdi::Pipeline pipeline(watching(), truth::kSample_s);
  Log log;
  run(pipeline, record, 0, record.y_m.size(), log);
  EXPECT_GE(log.warming_up, 11);  // of twelve windows
  // An alarm that is told again has another name or group: what it says in the end counts.
  std::vector<std::pair<double, fdi::Alarm>> told;
  for (const Log::Change& change : log.alarms) {
    if (!change.alarm.active) continue;
    if (told.empty() || told.back().second.name != change.alarm.name) {
      told.emplace_back(change.t_s, change.alarm);
    }
    told.back().second = change.alarm;
    EXPECT_EQ(change.alarm.direction, 1) << change.t_s << " " << change.alarm.reason;
  }
  ASSERT_EQ(told.size(), 2u);
  const auto& [damping_s, damping] = told[0];
  EXPECT_EQ(damping.source, "physics");
  EXPECT_EQ(damping.name, "damping_N_s_per_m");
  EXPECT_EQ(damping.parameter, "damping_N_s_per_m") << damping.reason;
  EXPECT_GT(damping_s, 12.0);
  EXPECT_LT(damping_s, 14.5);
  EXPECT_NEAR(damping.value, 1250.0, 5.0 * damping.std_error);
  EXPECT_THAT(damping.reason, HasSubstr("damping high"));
  const auto& [pressure_s, pressure] = told[1];
  EXPECT_EQ(pressure.parameter, "");
  EXPECT_THAT(pressure.ambiguity_group, ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V"));
  EXPECT_GT(pressure_s, 24.0);
  EXPECT_LT(pressure_s, 25.2);
  EXPECT_NEAR(pressure.value, 1.1 * 6.89e6, 0.002 * 6.89e6);
  EXPECT_GT(pressure.confidence, 0.99);
  EXPECT_THAT(pressure.reason, HasSubstr("a reading of the supply pressure would"));
  // supply pressure, damping, their smallest changes, residual; value and standard error of each
  const std::vector<double>& last = log.values.back();
  ASSERT_EQ(last.size(), 10u);
  EXPECT_NEAR(last[0], 1.1 * 6.89e6, 0.002 * 6.89e6);
  EXPECT_NEAR(last[2], 1000.0, 30.0);
  EXPECT_NEAR(last[4], 0.03 * 1.1 * 6.89e6, 0.02 * 0.03 * 6.89e6);  // the least that is named
  EXPECT_GT(last[6], 0.04 * 1000.0);
  EXPECT_LT(last[6], 0.09 * 1000.0);
}

const std::vector<std::string> kWithGain{"supply_pressure_Pa", "damping_N_s_per_m",
                                         "valve_gain_m_per_V"};

/// Valve gain 10 % low from 14 s on, as pressures of the chambers or of the supply are read.
truth::Record gain_falls(bool chambers, bool supply) {
  truth::Case of = stand(24.0);
  of.pressure_noise_Pa = 5e3;
  fault(of, 14.0, &truth::Plant::valve_gain_m_per_V, 0.9);
  truth::Record record = truth::simulate(of);
  if (!chambers) record.in_Pa.clear();
  if (!chambers) record.out_Pa.clear();
  if (!supply) record.supply_Pa.clear();
  return record;
}

TEST(TrackerMethod, TellsTheValveGainByPressuresThatTheSamplesCarry) {
  for (const bool chambers : {true, false}) {
    const truth::Record record = gain_falls(chambers, !chambers);
    fdi::Pipeline pipeline(watching(kWithGain), truth::kSample_s);
    Log log;
    run(pipeline, record, 0, record.y_m.size(), log);
    ASSERT_FALSE(log.alarms.empty());
    for (const Log::Change& change : log.alarms) {
      EXPECT_EQ(change.alarm.name, "valve_gain_m_per_V") << change.alarm.reason;
      EXPECT_EQ(change.alarm.parameter, "valve_gain_m_per_V");
      EXPECT_EQ(change.alarm.direction, -1);
    }
    EXPECT_NEAR(log.alarms.back().alarm.value, 0.9 * 2.79e-5, 0.01 * 2.79e-5);
  }
}

TEST(TrackerMethod, LeavesPressuresAloneWhereItIsTold) {
  const truth::Record record = gain_falls(true, true);
  fdi::PipelineConfig config(tracker::detection_method_kinds());
  auto tracker = std::make_unique<tracker::TrackerConfig>();
  tracker->id = "physics";
  tracker->model_toml = plant_sim::print_model(printed_model());
  tracker->learn_s = kLearn_s;
  tracker->pressures = false;
  config.add("tracker", std::move(tracker));
  fdi::Pipeline pipeline(config, truth::kSample_s);
  Log log;
  run(pipeline, record, 0, record.y_m.size(), log);
  ASSERT_FALSE(log.alarms.empty());
  EXPECT_THAT(log.alarms.back().alarm.ambiguity_group,
              ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V"));
}

TEST(TrackerConfig, KeepsWhatIsHealthyOfPressuresWhenItIsPrinted) {
  tracker::TrackerConfig config;
  config.id = "physics";
  config.pressures = false;
  config.learnt.chambers = {{5e3, -2e4, 7e3}, {6e3, 3e4, 8e3}, 1.4e4};
  const std::string text = config::schema::print_toml([&](auto& v) { config.visit(v); });
  tracker::TrackerConfig read;
  config::schema::Document::parse(text, "test").read([&](auto& v) { read.visit(v); });
  EXPECT_FALSE(read.pressures);
  const iso::ChamberErrors& chambers = read.learnt.chambers;
  EXPECT_EQ(chambers.in.rms_Pa, 5e3);
  EXPECT_EQ(chambers.in.offset_Pa, -2e4);
  EXPECT_EQ(chambers.in.weight_Pa, 7e3);
  EXPECT_EQ(chambers.out.rms_Pa, 6e3);
  EXPECT_EQ(chambers.out.offset_Pa, 3e4);
  EXPECT_EQ(chambers.out.weight_Pa, 8e3);
  EXPECT_EQ(chambers.offset_sd_Pa, 1.4e4);
}

TEST(TrackerMethod, SaysWhyItGoesOnByPositionAlone) {
  truth::Record record = gain_falls(true, false);
  for (std::size_t k = 2000; k < record.in_Pa.size(); ++k) record.in_Pa[k] = record.in_Pa[2000];
  fdi::Pipeline pipeline(watching(kWithGain), truth::kSample_s);
  Log log;
  run(pipeline, record, 0, 2799, log);
  EXPECT_TRUE(log.alarms.empty());
  EXPECT_THAT(log.reasons.back(), HasSubstr("valve gain"));  // is not told, and so invalid
  fdi::Pipeline without(watching(), truth::kSample_s);
  Log other;
  run(without, record, 0, 2799, other);
  EXPECT_THAT(other.reasons.back(), HasSubstr("the reading of the pressure in stands still"));
}

/// A pipeline that is saved and restored at a cut, and one that never was.
void expect_the_same(const fdi::PipelineConfig& config, const truth::Record& record,
                     const std::vector<std::size_t>& cuts) {
  for (const std::size_t data : cuts) {
    const std::size_t end = data + 900;
    fdi::Pipeline whole(config, truth::kSample_s);
    Log unused;
    run(whole, record, 0, data, unused);
    std::vector<std::uint8_t> bytes;
    fdi::save_snapshot(whole, 1, static_cast<std::int64_t>(data), bytes);
    fdi::Pipeline restored(config, truth::kSample_s);
    ASSERT_EQ(fdi::load_snapshot(bytes, 1, restored, "test"), static_cast<std::int64_t>(data));
    Log expected;
    Log found;
    run(whole, record, data, end, expected);
    run(restored, record, data, end, found);
    ASSERT_EQ(found.values.size(), expected.values.size());
    for (std::size_t i = 0; i < found.values.size(); ++i) {
      EXPECT_EQ(found.reasons[i], expected.reasons[i]);
      for (std::size_t j = 0; j < found.values[i].size(); ++j) {
        const double a = found.values[i][j];
        const double b = expected.values[i][j];
        EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " " << b;
      }
    }
    ASSERT_EQ(found.alarms.size(), expected.alarms.size());
    for (std::size_t i = 0; i < found.alarms.size(); ++i) {
      EXPECT_EQ(found.alarms[i].alarm.reason, expected.alarms[i].alarm.reason);
      EXPECT_EQ(found.alarms[i].alarm.value, expected.alarms[i].alarm.value);
    }
  }
}

TEST(TrackerMethod, GoesOnBitForBitFromASnapshot) {
  const truth::Record record = case_three();
  const fdi::PipelineConfig config = watching();
  expect_the_same(config, record, {700u, 2517u});  // while it learns; while an alarm stands
}

TEST(TrackerMethod, GoesOnBitForBitWithPressures) {
  truth::Record record = gain_falls(true, false);
  for (std::size_t k = 3600; k < record.in_Pa.size(); ++k) record.in_Pa[k] = record.in_Pa[3600];
  expect_the_same(watching(kWithGain), record, {700u, 2900u, 3700u});
}

constexpr double kLearnDisturbance_s = 20.0;

/// 30 N of random force and 1 bar of pulsation; the supply falls at 26 s.
truth::Record disturbed() {
  truth::Case of = stand(38.0, 9201);
  of.outside.force_N = 30.0;
  of.outside.pulsation_Pa = 1e5;
  fault(of, 26.0, &truth::Plant::supply_pressure_Pa, 0.9);
  return truth::simulate(of);
}

fdi::PipelineConfig watching_disturbed() {
  fdi::PipelineConfig config(tracker::detection_method_kinds());
  auto tracker = std::make_unique<tracker::TrackerConfig>();
  tracker->id = "physics";
  tracker->model_toml = plant_sim::print_model(printed_model());
  tracker->learn_disturbance_s = kLearnDisturbance_s;
  tracker->settings.disturbed_window_s = 8.0;
  config.add("tracker", std::move(tracker));
  return config;
}

TEST(TrackerMethod, TellsWhatDisturbsTheRigAndNamesAChangeUnderIt) {
  const truth::Record record = disturbed();
  fdi::Pipeline pipeline(watching_disturbed(), truth::kSample_s);
  Log log;
  run(pipeline, record, 0, record.y_m.size(), log);
  ASSERT_FALSE(log.alarms.empty());
  for (const Log::Change& change : log.alarms) {
    EXPECT_EQ(change.alarm.name, "supply_pressure_Pa") << change.t_s << " " << change.alarm.reason;
    EXPECT_EQ(change.alarm.direction, -1);
  }
  EXPECT_LT(log.alarms[0].t_s, 28.0);
  const std::vector<double>& last = log.values.back();
  ASSERT_EQ(last.size(), 10u + 2u * 8u);
  EXPECT_NEAR(last[0], 0.9 * 6.89e6, 4.0 * last[1]);
  EXPECT_NEAR(last[10], 30.0, 0.4 * 30.0);  // disturbance_force_N
  EXPECT_TRUE(std::isnan(last[12]));        // disturbance_speed_mps: of other plants
  EXPECT_NEAR(last[18], 23.0, 0.1);         // disturbance_pressure_line_Hz
  EXPECT_NEAR(last[20], 1e5, 0.4 * 1e5);    // disturbance_pressure_line_Pa
}

TEST(TrackerMethod, GoesOnBitForBitOnADisturbedRig) {
  expect_the_same(watching_disturbed(), disturbed(), {3000u, 4900u, 5400u});
}

TEST(TrackerConfig, KeepsADisturbanceWhenItIsPrinted) {
  tracker::TrackerConfig config;
  config.id = "physics";
  iso::ProcessNoise noise;
  noise.model.noise = {30.0, 3.0, 1e-8, 2.5e-6};
  noise.model.lines = {{iso::LineSite::supply, 23.0}};
  noise.healthy.line_values = {1e5};
  noise.covariance.resize(2, 2);
  noise.covariance << 1e-8, -2e-8, -2e-8, 1e-4;
  config.learnt.noise = noise;
  const std::string text = config::schema::print_toml([&](auto& v) { config.visit(v); });
  tracker::TrackerConfig read;
  config::schema::Document::parse(text, "test").read([&](auto& v) { read.visit(v); });
  ASSERT_TRUE(read.learnt.noise.has_value());
  EXPECT_EQ(read.learnt.noise->model.noise.disturbance_sd, 30.0);
  EXPECT_EQ(read.learnt.noise->model.noise.walk_m, 1e-8);
  ASSERT_EQ(read.learnt.noise->model.lines.size(), 1u);
  EXPECT_EQ(read.learnt.noise->model.lines[0].site, iso::LineSite::supply);
  EXPECT_EQ(read.learnt.noise->healthy.line_values[0], 1e5);
  EXPECT_EQ(read.learnt.noise->covariance, noise.covariance);
}

TEST(TrackerMethod, AlarmsWhenTheModelNoLongerExplainsTheRig) {
  truth::Case of = stand(20.0);
  of.changes.push_back({12.0, nullptr, &truth::Hidden::backlash_m, 60e-6});
  const truth::Record record = truth::simulate(of);
  fdi::Pipeline pipeline(watching(), truth::kSample_s);
  Log log;
  run(pipeline, record, 0, record.y_m.size(), log);
  ASSERT_EQ(log.alarms.size(), 1u);
  EXPECT_EQ(log.alarms[0].alarm.name, "unexplained");
  EXPECT_GT(log.alarms[0].t_s, 14.0);
  EXPECT_LT(log.alarms[0].t_s, 16.5);
}

TEST(TrackerMethod, SuggestsAMotionWithinItsLimitsWhereTheRodStandsStill) {
  truth::Record record = truth::simulate(stand(9.0));
  for (int k = 0; k < 1000; ++k) {
    record.u_V.push_back(0.0);
    record.y_m.push_back(record.y_m.back());
  }
  fdi::PipelineConfig config(tracker::detection_method_kinds());
  auto tracker = std::make_unique<tracker::TrackerConfig>();
  tracker->id = "physics";
  tracker->model_toml = plant_sim::print_model(printed_model());
  tracker->learn_s = 3.0;
  tracker->settings.probe = {0.28, 0.33, 0.1, 10.0};
  config.add("tracker", std::move(tracker));
  fdi::Pipeline pipeline(config, truth::kSample_s);
  Log log;
  run(pipeline, record, 0, record.y_m.size(), log);
  EXPECT_THAT(log.reasons.back(), HasSubstr("no motion"));
  EXPECT_THAT(log.reasons.back(), HasSubstr("about 305 mm"));
  EXPECT_THAT(log.reasons.back(), HasSubstr("probe with a sine of "));
  EXPECT_TRUE(log.alarms.empty());
}

TEST(TrackerMethod, SaysThatSamplesAreMissing) {
  const truth::Record record = truth::simulate(stand(4.0));
  fdi::Pipeline pipeline(watching(), truth::kSample_s);
  Log log;
  run(pipeline, record, 0, 600, log);
  const std::size_t before = log.reasons.size();
  config::signals::Sample sample;
  for (std::int64_t tick = 600; tick < 800; ++tick) {
    sample.tick = tick;
    sample.y_m = NAN;
    pipeline.process(sample, log);
  }
  ASSERT_EQ(log.reasons.size(), before + 2);
  EXPECT_EQ(log.reasons.back(), "samples are missing");
  EXPECT_TRUE(std::isnan(log.values.back()[0]));
}

}  // namespace
