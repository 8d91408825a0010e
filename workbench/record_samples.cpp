#include "workbench/record_samples.h"

#include <cmath>
#include <limits>

namespace workbench {

std::vector<estimator::fdi::Sample> to_samples(const config::record::Record& record) {
  const auto at = [&record](const char* name) { return record.column(name); };
  const std::vector<double>* reference = at("reference_m");
  const std::vector<double>* requested = at("u_requested_V");
  const std::vector<double>* quality = at("quality");
  const std::vector<double>* state = at("state");
  const std::vector<double>* saturated = at("saturated");
  std::vector<estimator::fdi::Sample> samples(record.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    estimator::fdi::Sample& s = samples[i];
    const double periods = (record.t_s[i] - record.t_s.front()) / record.sample_time_s;
    s.tick = std::llround(periods);
    s.gap = i == 0 ? 0 : static_cast<std::int32_t>(s.tick - samples[i - 1].tick - 1);
    s.t_read_ns = std::llround(record.t_s[i] * 1e9);
    s.t_write_ns = s.t_read_ns;
    s.utc_us = std::llround(record.t_s[i] * 1e6);
    s.y_m = record.y_m[i];
    s.u_applied_V = record.u_V[i];
    s.u_requested_V = requested != nullptr ? (*requested)[i] : record.u_V[i];
    s.reference_m =
        reference != nullptr ? (*reference)[i] : std::numeric_limits<double>::quiet_NaN();
    if (quality != nullptr && (*quality)[i] >= 0.0 && (*quality)[i] <= 3.0) {
      s.quality = static_cast<estimator::fdi::Quality>((*quality)[i]);
    }
    if (state != nullptr && (*state)[i] >= 0.0 && (*state)[i] <= 255.0) {
      s.state = static_cast<std::uint8_t>((*state)[i]);
    }
    s.saturated = saturated != nullptr && (*saturated)[i] > 0.0;
  }
  return samples;
}

}  // namespace workbench
