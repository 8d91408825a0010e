// The control loop of a commissioning: reads the rod sensor and the auxiliary inputs once a period
// and writes the procedure's command, null between stages. Runs on its own thread in real time, on
// the caller's thread in virtual time.
#pragma once

#include <atomic>
#include <functional>

#include "daemon/control/commissioning.h"
#include "daemon/rt/auxiliary_inputs.h"
#include "daemon/rt/grid.h"
#include "hal/thread.h"

namespace monitor {

class CommissionLoop {
 public:
  struct Parts {
    rt::Clock& clock;
    const hal::Devices& devices;
    hal::ValveDrive& valve;
    double null_V;
    double sample_time_s;
    std::int64_t max_bad_in_a_row;
  };
  /// Why a stage ended for reasons outside the procedure.
  enum class Stop : std::uint8_t { none, e_stop, not_enabled, valve_lost, stood_still };

  /// In virtual time no thread is started.
  CommissionLoop(const Parts& parts, control::Commissioning& procedure, bool virtual_time);
  ~CommissionLoop();
  CommissionLoop(const CommissionLoop&) = delete;
  CommissionLoop& operator=(const CommissionLoop&) = delete;

  /// Returns 0 or an errno.
  int start(const hal::ThreadOptions& options);
  /// Runs the stage that the procedure has begun. Returns false when `stop_asked`, which may wait
  /// briefly, returned true; null is being written by then.
  bool run_stage(const std::function<bool()>& stop_asked);
  /// Writes null and ends the loop. Returns false when a device call does not return.
  bool end();

  [[nodiscard]] Stop stop() const noexcept { return stop_.load(std::memory_order_relaxed); }
  [[nodiscard]] config::signals::Quality quality() const noexcept {
    return quality_.load(std::memory_order_relaxed);
  }

 private:
  void tick() noexcept;

  Parts parts_;
  control::Commissioning& procedure_;
  bool virtual_time_;
  rt::Grid grid_;
  rt::LoopStats stats_;
  rt::AuxiliaryInputs aux_inputs_;
  double start_s_;
  double applied_V_ = hal::kMissing;  ///< by the last write
  std::int64_t bad_writes_ = 0;
  bool permit_on_ = false;
  std::atomic<bool> stage_{false};  ///< the loop owns the procedure, otherwise the caller
  std::atomic<bool> abandon_{false};
  std::atomic<bool> end_{false};
  std::atomic<Stop> stop_{Stop::none};
  std::atomic<config::signals::Quality> quality_{config::signals::Quality::bad};
  hal::Thread thread_;
};

[[nodiscard]] const char* to_string(CommissionLoop::Stop stop) noexcept;

}  // namespace monitor
