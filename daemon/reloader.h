// Reads the configuration again while the daemon runs: all of it is checked, only rules
// (detection_config.h) may differ, and the detector takes them between two samples. Whatever is
// wrong, the old ones stay. Each attempt is written to the log, to the audit file and into the
// service manager's status.
//
// One thread, the main one.
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

namespace monitor {

/// What became of an attempt.
struct ReloadOutcome {
  std::string reject_reason;         ///< empty: done
  std::vector<std::string> changed;  ///< keys, as differences() names them
  std::vector<std::string> warm, cold, ended;
  std::int64_t utc_us = 0;  ///< 0: there was none
};

class Reloader {
 public:
  /// What it works with; all of it outlives this. `audit` and `evidence` may be missing.
  struct Parts {
    const rt::Clock& clock;
    std::ostream& log;
    io::Audit* audit;
    bool evidence;  ///< is kept
    /// Reads the configuration as at the start; throws config::schema::Error.
    std::function<void(DaemonConfig&)> read;
    std::uint64_t rules_hash;  ///< of the rules at the start, fdi::hash_of(DetectionConfig::text)
  };
  /// `running`: what the daemon runs by; its rules are kept up to date.
  Reloader(Parts parts, DaemonConfig& running, double sample_time_s);

  /// Begins, unless an attempt is under way: then false. `what`: by which way it was asked for.
  bool begin(unsigned uid, const std::string& what);
  /// Looks whether the detector has taken the rules.
  void look();
  [[nodiscard]] bool busy() const noexcept { return under_way_ != nullptr; }
  /// Of the newest attempt that has ended.
  [[nodiscard]] const ReloadOutcome& last() const noexcept { return last_; }
  [[nodiscard]] const std::string& config_hash() const noexcept { return config_hash_; }
  /// Of the rules with the learned bands in them.
  [[nodiscard]] const std::string& rules_hash() const noexcept { return rules_hash_; }
  [[nodiscard]] const DaemonConfig& running() const noexcept { return running_; }
  [[nodiscard]] double sample_time_s() const noexcept { return sample_time_s_; }
  /// One line when the newest attempt was refused, else empty.
  [[nodiscard]] std::string complaint() const;

  detection::DetectionUpdateQueue to_detector, from_detector;

 private:
  struct UnderWay {
    unsigned uid;
    std::string what;
    DaemonConfig next;
    std::vector<std::string> changed;
  };
  void prepare(UnderWay& under_way);
  void end(ReloadOutcome outcome);

  Parts parts_;
  DaemonConfig& running_;
  double sample_time_s_;
  std::string config_hash_, rules_hash_;
  std::unique_ptr<UnderWay> under_way_;
  ReloadOutcome last_;
};

}  // namespace monitor
