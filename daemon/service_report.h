// When the service manager is told what: ready after the first good cycles, a line of status once a
// second, and a sign of life only while both the loop and the detector get on.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/io/service_manager.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_stats.h"

namespace monitor {

/// Cycles with a good reading, a good write where there is a valve, and the sample through the
/// detector: so many, and the service is up.
inline constexpr std::int64_t kGoodCycles = 20;

class ServiceReport {
 public:
  /// All of it outlives the report. `drives`: there is a valve.
  ServiceReport(const io::ServiceManager& manager, const rt::Clock& clock,
                const rt::LoopStats& stats, bool drives) noexcept
      : manager_(manager), clock_(clock), stats_(stats), drives_(drives) {}

  /// Tells what is due. On the main thread, several times in a quarter of the watchdog's time.
  void look();
  void stopping() const { manager_.stopping(); }
  /// Added to the line of status; empty: nothing.
  void remark(const std::string& remark) { remark_ = remark; }

 private:
  [[nodiscard]] bool works() const noexcept;
  void feed(std::int64_t now_ns);
  void say(std::int64_t now_ns);
  [[nodiscard]] std::string line() const;

  const io::ServiceManager& manager_;
  const rt::Clock& clock_;
  const rt::LoopStats& stats_;
  bool drives_;
  bool ready_ = false;
  std::int64_t fed_ns_ = 0;
  std::int64_t fed_ticks_ = 0;     ///< of the loop, at the last sign of life
  std::int64_t fed_detected_ = 0;  ///< of the detector, likewise
  std::int64_t next_line_ns_ = 0;
  std::string said_;
  std::string remark_;
};

}  // namespace monitor
