// The pipeline takes no memory once it runs.
#include <gtest/gtest.h>

#include <cmath>

#include "estimator/fdi/pipeline.h"
#include "tests/count_allocations.h"

namespace estimator::fdi {
namespace {

class Counter final : public Events {
 public:
  void on_estimate(const EstimateEvent& /*event*/) override { ++estimates; }
  void on_alarm(const Alarm& /*alarm*/) override {}
  int estimates = 0;
};

TEST(Pipeline, DoesNotAllocateInSteadyState) {
  if (SPOOLWATCH_COUNTS_MALLOC == 0) GTEST_SKIP() << "the sanitizer owns malloc";
  PipelineConfig config;
  for (const char* method : {"batch", "sliding", "recursive"}) {
    EstimatorConfig estimator;
    estimator.id = method;
    estimator.structure = "arx211";
    estimator.method = method;
    estimator.window_s = 1.0;
    estimator.filter = "low";
    estimator.filter_high_Hz = 50.0;
    config.estimators.push_back(estimator);
    BandConfig band;
    band.id = method;
    band.quantity = std::string(method) + ".b1";
    band.low = -1.0;
    band.high = 1.0;
    config.bands.push_back(band);
  }
  config.estimators[0].detrend = "linear";
  Pipeline pipeline(config, 0.005);
  Counter events;
  config::signals::Sample s;
  const auto run = [&](int samples) {
    for (int i = 0; i < samples; ++i, ++s.tick) {
      s.u_applied_V = std::sin(0.03 * static_cast<double>(s.tick)) +
                      0.3 * std::sin(0.4 * static_cast<double>(s.tick));
      s.y_m += 1e-3 * s.u_applied_V;
      pipeline.process(s, events);
    }
  };
  run(1000);
  const long before = allocations;
  const int estimates_before = events.estimates;
  run(1000);
  s.tick += 50;
  run(1000);
  EXPECT_GT(events.estimates, estimates_before + 500);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace estimator::fdi
