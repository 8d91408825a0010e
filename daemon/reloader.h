// Reloads the configuration of the running daemon. The whole file is checked; only the detection
// configuration (detection_config.h) and the limits of guards may differ. The loop takes new limits
// first, between two ticks: those that let more pass only while nothing is armed. Then the detector
// applies the update between two samples. On any error the old configuration stays. Each attempt is
// written to the log, to the audit file and to the service manager's status.
//
// Main thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "daemon/daemon_config.h"
#include "daemon/detection/detection_update.h"
#include "daemon/io/audit.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/queues.h"

namespace monitor {

/// The result of a reload.
struct ReloadOutcome {
  std::string reject_reason;         ///< empty: applied
  std::vector<std::string> changed;  ///< keys as differences() names them
  std::vector<std::string> warm, cold, ended;
  std::int64_t utc_us = 0;  ///< 0: no attempt yet
};

class Reloader {
 public:
  /// Collaborators; must outlive this object. `audit` may be null.
  struct Parts {
    const rt::Clock& clock;
    std::ostream& log;
    io::Audit* audit;
    bool evidence;  ///< evidence folders are configured
    /// Reads the configuration in the same way as at startup; throws config::schema::Error.
    std::function<void(DaemonConfig&)> read;
    std::uint64_t rules_hash;  ///< schema::hash_of(DetectionConfig::text) at startup
    /// To the loop; null: the limits of guards cannot change.
    rt::CommandQueue* commands = nullptr;
  };
  /// `running`: the active configuration; updated after each successful reload.
  Reloader(Parts parts, DaemonConfig& running, double sample_time_s);

  /// Starts a reload. Returns false while another one is in progress. `what`: the request, for the
  /// audit file.
  bool begin(unsigned uid, const std::string& what);
  /// Completes the reload once the loop and the detector have applied the
  /// update.
  void poll();
  [[nodiscard]] bool busy() const noexcept { return attempt_ != nullptr; }
  /// The result of the newest completed attempt.
  [[nodiscard]] const ReloadOutcome& last() const noexcept { return last_; }
  [[nodiscard]] const std::string& config_hash() const noexcept { return config_hash_; }
  /// Hash of the detection configuration, learned bands included.
  [[nodiscard]] const std::string& rules_hash() const noexcept { return rules_hash_; }
  [[nodiscard]] const DaemonConfig& running() const noexcept { return running_; }
  [[nodiscard]] double sample_time_s() const noexcept { return sample_time_s_; }
  /// One line when the newest attempt was rejected, else empty.
  [[nodiscard]] std::string complaint() const;

  detection::DetectionUpdateQueue to_detector, from_detector;

 private:
  struct Attempt {
    unsigned uid;
    std::string what;
    DaemonConfig next;
    std::vector<std::string> changed;
    std::shared_ptr<detection::DetectionUpdate> update;
    std::shared_ptr<rt::GuardUpdate> guards;  ///< null: they stay
    std::string loosened;                     ///< the first limit that lets more pass
    std::int64_t deadline_ns = 0;             ///< the loop must answer by then
  };
  void prepare(Attempt& attempt);
  /// Adds the new limits, and sends them to the loop.
  void send_limits(Attempt& attempt);
  /// True once the loop has taken the limits, or where there are none. Throws when it has not.
  [[nodiscard]] bool limits_taken(Attempt& attempt);
  void send_to_detector();
  /// Ends the attempt with the reason.
  void reject(const std::exception& error);
  void end(ReloadOutcome outcome);

  Parts parts_;
  DaemonConfig& running_;
  double sample_time_s_;
  std::string config_hash_, rules_hash_;
  std::unique_ptr<Attempt> attempt_;
  /// Updates that the loop may still look at.
  std::vector<std::shared_ptr<rt::GuardUpdate>> sent_;
  ReloadOutcome last_;
};

}  // namespace monitor
