// State of the live view: the newest of everything, and short histories.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "config/signals/nan.h"
#include "workbench/live/listen_feed.h"

namespace workbench::live {

using config::signals::kNaN;

/// Times are the sender's wall clock (virtual: from 0).
struct MotionPoint {
  double t_s;
  double reference_m;
  double y_m;
};

struct ValuePoint {
  double t_s;
  double value;
  bool valid;
};

/// One quantity that is watched: b1 of an estimator.
struct TrackedQuantity {
  std::string source;
  std::string quantity;
  double value = kNaN;
  double std_error = kNaN;
  double low = kNaN;
  double high = kNaN;
  bool valid = false;
  std::string reason;
  std::deque<ValuePoint> history;
};

struct AlarmRow {
  std::string name;  // source.name
  std::int64_t utc_us = 0;
  int severity = 0;
  bool active = false;
  double value = kNaN;
  double low = kNaN;
  double high = kNaN;
  std::string parameter;
  int direction = 0;
  std::string reason;
};

struct HealthFigures {
  std::string rig_id;
  std::string privileges;
  std::int64_t overruns = 0;
  std::int64_t skipped_periods = 0;
  std::int64_t dropped_samples = 0;
  std::int64_t dropped_records = 0;
  std::int64_t lost_records = 0;
  double lateness_p50_us = kNaN;
  double lateness_p999_us = kNaN;
  double lateness_max_us = kNaN;
};

class LiveState final : public FeedListener {
 public:
  static constexpr double kMotionSpan_s = 10.0;
  static constexpr double kValueSpan_s = 60.0;

  void on(const spoolwatch::sample_t& sample) override;
  void on(const spoolwatch::estimate_t& estimate) override;
  void on(const spoolwatch::alarm_t& alarm) override;
  void on(const spoolwatch::health_t& health) override;
  void on_new_run(std::int64_t run_id, bool first) override;
  void on_lost(const std::string& channel, std::int64_t count) override;
  void on_silence(bool silent) override { silent_ = silent; }
  void on_notice(const std::string& what) override { notice_ = what; }

  [[nodiscard]] const std::deque<MotionPoint>& motion() const { return motion_; }
  [[nodiscard]] const std::vector<TrackedQuantity>& tracks() const { return tracks_; }
  /// Newest change first.
  [[nodiscard]] const std::vector<AlarmRow>& alarms() const { return alarms_; }
  [[nodiscard]] const HealthFigures& health() const { return health_; }
  [[nodiscard]] bool heard() const { return heard_; }
  [[nodiscard]] bool silent() const { return silent_; }
  [[nodiscard]] int state() const { return state_; }
  [[nodiscard]] double command_V() const { return command_V_; }
  [[nodiscard]] std::int64_t run_id() const { return run_id_; }
  [[nodiscard]] std::int64_t utc_us() const { return utc_us_; }
  [[nodiscard]] std::int64_t lost_messages() const { return lost_messages_; }
  [[nodiscard]] const std::string& notice() const { return notice_; }

 private:
  std::deque<MotionPoint> motion_;
  std::vector<TrackedQuantity> tracks_;
  std::vector<AlarmRow> alarms_;
  HealthFigures health_;
  bool heard_ = false;
  bool silent_ = false;
  int state_ = -1;
  double command_V_ = kNaN;
  std::int64_t run_id_ = 0;
  std::int64_t utc_us_ = 0;
  std::int64_t lost_messages_ = 0;
  std::string notice_;
};

}  // namespace workbench::live
