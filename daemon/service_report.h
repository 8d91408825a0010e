// Reports to the service manager: ready after the first good cycles, a status line once a second,
// and watchdog keep-alives only while both the loop and the detector make progress.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/io/service_manager.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_stats.h"

namespace monitor {

/// The service is ready after this many cycles with a good reading, a good write (if a valve is
/// driven) and a sample processed by the detector.
inline constexpr std::int64_t kGoodCycles = 20;

class ServiceReport {
 public:
  /// All arguments must outlive this object. `drives`: a valve is driven.
  ServiceReport(const io::ServiceManager& manager, const rt::Clock& clock,
                const rt::LoopStats& stats, bool drives) noexcept
      : manager_(manager), clock_(clock), stats_(stats), drives_(drives) {}

  /// Sends whatever is due. Call from the main thread, several times per quarter of the watchdog
  /// time.
  void poll();
  void stopping() const { manager_.stopping(); }
  /// Appended to the status line; empty: nothing.
  void remark(const std::string& remark) { remark_ = remark; }

 private:
  [[nodiscard]] bool works() const noexcept;
  void feed(std::int64_t now_ns);
  void send_status(std::int64_t now_ns);
  [[nodiscard]] std::string line() const;

  const io::ServiceManager& manager_;
  const rt::Clock& clock_;
  const rt::LoopStats& stats_;
  bool drives_;
  bool ready_ = false;
  std::int64_t fed_ns_ = 0;
  std::int64_t fed_ticks_ = 0;     ///< loop ticks at the last keep-alive
  std::int64_t fed_detected_ = 0;  ///< detector samples at the last keep-alive
  std::int64_t next_line_ns_ = 0;
  std::string last_line_;
  std::string remark_;
};

}  // namespace monitor
