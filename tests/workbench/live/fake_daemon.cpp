// Sends what a daemon sends, without one: spoolwatch_fake_daemon URL SECONDS. A sine at 200 Hz, an
// estimate of b1 every 0.1 s that leaves its band a third of the way through and comes back at two
// thirds, alarms for it, and health once a second.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

#include "config/schema/error.h"
#include "daemon/io/publisher.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/health_t.hpp"

namespace {

using estimator::fdi::Severity;

constexpr double kSampleTime_s = 0.005;
constexpr double kLow = 1.99e-4;
constexpr double kHigh = 2.15e-4;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double noise(std::int64_t i) { return std::sin(static_cast<double>(i) * 12.9898) * 0.7; }

monitor::io::Stamp now() {
  using std::chrono::duration_cast;
  return {
      duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count(),
      duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count()};
}

class FakeDaemon {
 public:
  FakeDaemon(const std::string& url, std::int64_t ticks)
      : publisher_({.url = url}, 42, kSampleTime_s, nullptr), ticks_(ticks) {
    alarm_.source = "sliding";
    alarm_.name = "b1_low";
    alarm_.quantity = "sliding.b1";
    alarm_.parameter = "supply_pressure_Pa";
    alarm_.guidance = "check the supply pressure";
    alarm_.low = kLow;
    alarm_.high = kHigh;
  }

  void run() {
    auto next = std::chrono::steady_clock::now();
    for (std::int64_t tick = 0; tick < ticks_; ++tick) {
      sample(tick);
      if (tick % 20 == 0) estimates(tick);
      if (tick % 200 == 0) health(tick);
      next += std::chrono::milliseconds(5);
      std::this_thread::sleep_until(next);
    }
  }

 private:
  void sample(std::int64_t tick) {
    const double t_s = static_cast<double>(tick) * kSampleTime_s;
    const double phase = 2.0 * 3.141592653589793 * 0.5 * t_s;
    config::signals::Sample sample;
    sample.tick = tick;
    sample.utc_us = now().utc_us;
    sample.t_read_ns = now().mono_ns;
    sample.reference_m = 0.1 + 0.04 * std::sin(phase);
    sample.y_m = 0.1 + 0.037 * std::sin(phase - 0.35) + 1e-4 * noise(tick);
    sample.u_requested_V = sample.u_applied_V = 60.0 * (sample.reference_m - sample.y_m);
    sample.state = 3;
    publisher_.sample(sample);
  }

  void estimates(std::int64_t tick) {
    const bool fault = tick * 3 > ticks_ && tick * 3 < 2 * ticks_;
    const double b1 = (fault ? 1.93e-4 : 2.07e-4) + 2e-6 * noise(tick / 20);
    estimate("sliding", tick, b1, true);
    if (tick % 400 == 0) estimate("period", tick, b1, tick != 0);
    const bool repeat = tick % 200 == 0 && alarm_.active;
    if (fault == alarm_.active && !repeat) return;
    alarm_.active = fault;
    alarm_.severity = fault ? Severity::major : Severity::ok;
    alarm_.direction = fault ? -1 : 0;
    if (!repeat) alarm_.tick = tick;
    alarm_.value = b1;
    alarm_.std_error = 4e-7;
    publisher_.alarm(alarm_, repeat, now());
  }

  void estimate(const char* source, std::int64_t tick, double b1, bool valid) {
    const estimator::fdi::EstimatedValue values[] = {{"a1", -1.0002, 3e-5, kNaN, kNaN},
                                                     {"b1", b1, 4e-7, kLow, kHigh}};
    estimator::fdi::EstimateEvent event{};
    event.source = source;
    event.tick = tick;
    event.valid = valid;
    event.reason = valid ? "" : "too short";
    event.condition = 120.0;
    event.begin_values = std::begin(values);
    event.end_values = std::end(values);
    publisher_.estimate(event, now());
  }

  void health(std::int64_t tick) {
    spoolwatch::health_t health{};
    health.rig_id = "bench-1";
    health.state = 3;
    health.ticks = tick;
    health.lateness_p50_us = 6.1;
    health.lateness_p999_us = 18.4;
    health.lateness_max_us = 61.2;
    publisher_.health(health, now());
  }

  monitor::io::Publisher publisher_;
  std::int64_t ticks_;
  estimator::fdi::Alarm alarm_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  FakeDaemon(argv[1], static_cast<std::int64_t>(std::atof(argv[2]) / kSampleTime_s)).run();
  return 0;
}
