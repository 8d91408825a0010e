// How soon a sliding window of 0.3 s sees a change of the supply pressure, with a 5 um encoder,
// 12-bit D/A and 2 um noise, and that it stays silent otherwise.
//
// Why so short a window is enough: with y measured from the centre of the motion the free pole of
// ARX111 takes up the small part of the motion that lags the command, so b1 keeps within 0.7 % over
// all phases, far inside the printed band of about 7 %.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "tests/estimator/fdi/recorder.h"
#include "tests/estimator/fdi/small_rig.h"

namespace estimator::fdi {
namespace {

using small_rig::kSampleTime_s;

PipelineConfig sliding() {
  PipelineConfig config;
  EstimatorConfig estimator;
  estimator.id = "sliding";
  estimator.method = "sliding";
  estimator.window_s = 0.3;
  estimator.stride_s = 0.01;
  estimator.offset_m = 0.305;
  estimator.warmup_s = 2.0;
  estimator.min_u_rms_V = 0.2;
  config.estimators.push_back(estimator);
  BandConfig band;
  band.id = "supply_pressure";
  band.quantity = "sliding.b1";
  band.low = 1.80e-4;
  band.high = 2.10e-4;
  band.hysteresis = 0.01e-4;
  config.bands.push_back(band);
  return config;
}

/// Delay from the fault to its first alarm; fails on any alarm before or in the other direction.
double delay_s(double factor, double fault_s, unsigned seed) {
  small_rig::Setup setup;
  setup.seed = seed;
  small_rig::Rig rig(setup);
  Pipeline pipeline(sliding(), kSampleTime_s);
  fdi_test::Recorder seen;
  while (rig.time_s() < fault_s + 3.0) {
    if (rig.time_s() > fault_s - 1e-9) rig.supply_Pa = factor * setup.supply_Pa;
    pipeline.process(rig.step(), seen);
  }
  EXPECT_EQ(seen.alarms.size(), 1U) << "fault at " << fault_s << " s";
  if (seen.alarms.empty()) return 1e9;
  EXPECT_EQ(seen.alarms[0].direction, factor > 1.0 ? 1 : -1);
  const double alarm_s = static_cast<double>(seen.alarms[0].tick + 1) * kSampleTime_s;
  EXPECT_GT(alarm_s, fault_s);
  return alarm_s - fault_s;
}

TEST(DetectionDelay, IsUnderThreeTenthsInTheMedianAndSixTenthsAtWorstOverFortyFaultTimes) {
  for (const double factor : {1.25, 0.75}) {
    std::vector<double> delays_s;
    for (int i = 0; i < 40; ++i) {
      delays_s.push_back(delay_s(factor, 15.0 + 0.05 * i, static_cast<unsigned>(i) + 1));
    }
    std::sort(delays_s.begin(), delays_s.end());
    EXPECT_LE((delays_s[19] + delays_s[20]) / 2.0, 0.3);
    EXPECT_LE(delays_s.back(), 0.6);
    RecordProperty("median_ms", static_cast<int>(500.0 * (delays_s[19] + delays_s[20])));
    RecordProperty("worst_ms", static_cast<int>(1000.0 * delays_s.back()));
  }
}

TEST(DetectionDelay, AnHourWithoutAFaultBringsNoAlarmAcrossTheNormalClass) {
  for (const double factor : {0.9, 1.0, 1.1}) {
    small_rig::Setup setup;
    setup.supply_Pa *= factor;
    small_rig::Rig rig(setup);
    Pipeline pipeline(sliding(), kSampleTime_s);
    fdi_test::Recorder seen;
    const double hours = factor == 1.0 ? 1.0 : 0.1;
    while (rig.time_s() < 3600.0 * hours) {
      pipeline.process(rig.step(), seen);
      if (seen.estimates.size() > 1000) seen.estimates.clear();
    }
    EXPECT_TRUE(seen.alarms.empty()) << factor << ": " << seen.alarms[0].reason;
  }
}

}  // namespace
}  // namespace estimator::fdi
