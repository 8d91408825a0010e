// A pipeline from TOML that is fed plain numbers as positions: sample.y_m is the value tested.
#pragma once

#include <string>
#include <vector>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/pipeline.h"

namespace fdi_test {

inline estimator::fdi::PipelineConfig read_rules(const std::string& text) {
  estimator::fdi::PipelineConfig config;
  config::schema::Document::parse("schema_version = 1\n" + text, "test.toml")
      .read([&](config::schema::Visitor& v) { config.visit(v); });
  return config;
}

class PlainValues final : public estimator::fdi::Events {
 public:
  explicit PlainValues(const std::string& rules, double sample_time_s = 1.0)
      : pipeline(read_rules(rules), sample_time_s) {}

  void feed(double y_m, double u_V = 0.0, double reference_m = 0.0) {
    config::signals::Sample s;
    s.tick = tick++;
    s.y_m = y_m;
    s.u_applied_V = u_V;
    s.reference_m = reference_m;
    pipeline.process(s, *this);
  }
  void restart() {
    pipeline.reset();
    alarms.clear();
    tick = 0;
  }
  /// The newest value of that name; NaN when there was none.
  [[nodiscard]] double last(const std::string& name) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    for (const auto& v : values) value = v.name == name ? v.value : value;
    return value;
  }
  [[nodiscard]] double last_error(const std::string& name) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    for (const auto& v : values) value = v.name == name ? v.std_error : value;
    return value;
  }

  void on_estimate(const estimator::fdi::EstimateEvent& event) override {
    ++estimates;
    valid = event.valid;
    reason = event.reason;
    values.assign(event.begin(), event.end());
  }
  void on_alarm(const estimator::fdi::Alarm& alarm) override { alarms.push_back(alarm); }

  estimator::fdi::Pipeline pipeline;
  std::vector<estimator::fdi::EstimatedValue> values;
  std::vector<estimator::fdi::Alarm> alarms;
  std::string reason;
  bool valid = false;
  int estimates = 0;
  std::int64_t tick = 0;
};

/// The refusal of making it, "" when there is none; the exit code must be 78.
inline std::string refusal(const std::string& rules) {
  try {
    estimator::fdi::Pipeline(read_rules(rules), 1.0);
  } catch (const config::schema::ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace fdi_test
