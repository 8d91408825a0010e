// The source's detection cases on an independent simulation: printed bands, printed times.
#include <gtest/gtest.h>

#include <vector>

#include "estimator/fdi/pipeline.h"
#include "tests/estimator/fdi/recorder.h"
#include "tests/estimator/fdi/small_rig.h"

namespace estimator::fdi {
namespace {

using small_rig::kSampleTime_s;

PipelineConfig per_period(double low, double high) {
  PipelineConfig config;
  EstimatorConfig estimator;
  estimator.id = "period";
  estimator.window_s = 2.0;
  estimator.offset_m = 0.305;
  estimator.warmup_s = 2.0;
  config.estimators.push_back(estimator);
  BandConfig band;
  band.id = "case";
  band.quantity = "period.b1";
  band.low = low;
  band.high = high;
  config.bands.push_back(band);
  return config;
}

struct Change {
  double t_s;  // end of the window that brought it
  int direction;
};

/// The parameter is 1, 1.25, 1, 0.75 times normal, changing at 15, 30 and 45 s; 60 s in all.
std::vector<Change> changes(const PipelineConfig& config, bool supply, bool instruments) {
  small_rig::Setup setup;
  setup.instruments = instruments;
  small_rig::Rig rig(setup);
  Pipeline pipeline(config, kSampleTime_s);
  fdi_test::Recorder seen;
  while (rig.time_s() < 60.0) {
    const double t_s = rig.time_s();
    const double factor = t_s < 15.0 ? 1.0 : t_s < 30.0 ? 1.25 : t_s < 45.0 ? 1.0 : 0.75;
    if (supply) {
      rig.supply_Pa = setup.supply_Pa * factor;
    } else {
      rig.damping_N_s_per_m = setup.damping_N_s_per_m * factor;
    }
    pipeline.process(rig.step(), seen);
  }
  std::vector<Change> out;
  for (const Alarm& alarm : seen.alarms) {
    out.push_back({static_cast<double>(alarm.tick + 1) * kSampleTime_s, alarm.direction});
  }
  return out;
}

void expect_printed_times(const std::vector<Change>& found, int first, int last) {
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0].t_s, 18.0, 1e-9);
  EXPECT_EQ(found[0].direction, first);
  EXPECT_NEAR(found[1].t_s, 32.0, 1e-9);
  EXPECT_EQ(found[1].direction, 0);
  EXPECT_NEAR(found[2].t_s, 48.0, 1e-9);
  EXPECT_EQ(found[2].direction, last);
}

TEST(Cases, TheSupplyPressureAlarmsComeAndGoAtThePrintedTimes) {
  for (const bool instruments : {false, true}) {
    expect_printed_times(changes(per_period(1.80e-4, 2.10e-4), true, instruments), 1, -1);
  }
}

TEST(Cases, TheDampingAlarmsComeAndGoAtThePrintedTimesWithoutNoise) {
  expect_printed_times(changes(per_period(1.9645e-4, 1.9695e-4), false, false), -1, 1);
}

}  // namespace
}  // namespace estimator::fdi
