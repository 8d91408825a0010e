// Counts heap allocations of this thread through replaced global operators.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "estimator/fdi/pipeline.h"

namespace {
thread_local long allocations = 0;
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace estimator::fdi {
namespace {

class Counter final : public Events {
 public:
  void on_estimate(const EstimateEvent& /*event*/) override { ++estimates; }
  void on_alarm(const Alarm& /*alarm*/) override {}
  int estimates = 0;
};

TEST(Pipeline, DoesNotAllocateInSteadyState) {
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
  Sample s;
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
