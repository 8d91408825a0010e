// Goes through an LCM event log of the daemon, message by message, in the order in which they were
// told. Samples come exactly as the fault detection took them, whatever their quality.
#pragma once

#include <string>

#include "estimator/fdi/sample.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace workbench::replay {

class LogVisitor {
 public:
  virtual ~LogVisitor() = default;
  /// `rods`: what was told of several rod sensors in this sample; null where there is one alone.
  virtual void on_sample(const spoolwatch::sample_t& sample, const spoolwatch::rods_t* rods) = 0;
  virtual void on_estimate(const spoolwatch::estimate_t& /*estimate*/) {}
  virtual void on_alarm(const spoolwatch::alarm_t& /*alarm*/) {}
};

/// `prefix` of the channels; a last event that is cut off is left out. Throws
/// config::schema::Error (exit 65) for a file that cannot be read or a message of another type.
void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor);

/// The prefix of the first sample's channel; "" when there is none.
[[nodiscard]] std::string find_prefix(const std::string& file);

[[nodiscard]] estimator::fdi::Sample to_sample(const spoolwatch::sample_t& message,
                                               const spoolwatch::rods_t* rods) noexcept;

}  // namespace workbench::replay
