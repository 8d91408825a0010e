// Messages as text: one readable line, or one JSON object.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>

#include "workbench/live/listen_feed.h"

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

/// The line printer of `listen`: every message it is given, as text or JSON, flushed at once.
class LinePrinter final : public FeedListener {
 public:
  /// With `alarms_only`, estimates are left out.
  LinePrinter(std::ostream& out, bool json, bool alarms_only = false)
      : out_(out), json_(json), alarms_only_(alarms_only) {}

  void on(const spoolwatch::estimate_t& estimate) override;
  /// As text, the 1 Hz repeat of an active alarm is printed only when its coming was not seen.
  void on(const spoolwatch::alarm_t& alarm) override;
  void on(const spoolwatch::health_t& health) override;
  void on_new_run(std::int64_t run_id, bool first) override;
  void on_lost(const std::string& channel, std::int64_t count) override;
  void on_silence(bool silent) override;
  void on_notice(const std::string& what) override;

 private:
  void line(const std::string& text);
  /// `kind` is the JSON type and the second column of the text.
  void event(const char* kind, const std::string& what);

  std::ostream& out_;
  const bool json_;
  const bool alarms_only_;
  std::map<std::string, int> active_;  // severity by source.name
};

}  // namespace workbench::live
