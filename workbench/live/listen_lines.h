// Messages as text: one readable line, or one JSON object.
#pragma once

#include <cstdint>
#include <string>

namespace spoolwatch {
class estimate_t;
class alarm_t;
class health_t;
}  // namespace spoolwatch

namespace workbench::live {

/// "2026-11-21 03:15:38.123Z", or "12.345 s" for virtual time, which counts from 0.
[[nodiscard]] std::string time_text(std::int64_t utc_us);
/// "OK", "MINOR", "MAJOR", "INVALID".
[[nodiscard]] const char* severity_text(int severity);
/// "MONITOR", "DISARMED", ...
[[nodiscard]] const char* state_text(int state);
/// Six significant digits; "-" for NaN.
[[nodiscard]] std::string number_text(double value, int digits = 6);

[[nodiscard]] std::string readable(const spoolwatch::alarm_t& alarm);
[[nodiscard]] std::string readable(const spoolwatch::estimate_t& estimate);

/// Without line end; NaN becomes null.
[[nodiscard]] std::string json(const spoolwatch::alarm_t& alarm);
[[nodiscard]] std::string json(const spoolwatch::estimate_t& estimate);
[[nodiscard]] std::string json(const spoolwatch::health_t& health);

}  // namespace workbench::live
