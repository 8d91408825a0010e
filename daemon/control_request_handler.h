// Forwards requests from the control socket: commands to the loop, alarm commands to the detector,
// reloads to the reloader, one at a time, and returns their answers. Runs on the main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/control/reject_reason.h"
#include "daemon/detection/alarm_command_queue.h"
#include "daemon/detection/detectability_monitor.h"
#include "daemon/io/audit.h"
#include "daemon/io/control_messages.h"
#include "daemon/io/control_socket.h"
#include "daemon/reloader.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_stats.h"
#include "daemon/rt/queues.h"

namespace monitor {

class ControlRequestHandler {
 public:
  /// Collaborators; must outlive this object.
  struct Parts {
    rt::Clock& clock;
    rt::CommandQueue& commands;
    const rt::LoopStats& stats;
    detection::AlarmCommandQueue* alarm_commands =
        nullptr;  ///< null like `alarm_answers`: alarm commands are rejected
    detection::AlarmAnswerQueue* alarm_answers = nullptr;
    io::Audit* audit = nullptr;
    Reloader* reloader = nullptr;  ///< null: reloads are rejected
    const detection::DetectabilityMonitor* detectability = nullptr;
  };
  /// Facts that stay constant while the daemon runs.
  struct Identity {
    std::string rig_id, config_hash;
    std::vector<control::GuardConfig> guards;  ///< control::all_guards
    std::vector<std::string> spare_rods, inputs;
    std::vector<std::size_t> enables, e_stops;  ///< indices into `inputs`
    std::string never_arms;  ///< why the rig cannot be armed as configured; empty: it can
  };

  ControlRequestHandler(const Parts& parts, Identity identity);

  /// Handles a bounded number of requests. Returns true when more work is pending: an outstanding
  /// answer or further requests.
  bool serve(io::ControlSocket& socket);

 private:
  enum class WaitsFor : std::uint8_t { nothing, loop, detector, reloader };

  /// The answer, or an empty string when another thread will provide it.
  [[nodiscard]] std::string handle(const io::ControlRequest& request);
  [[nodiscard]] std::string send_to_loop(const io::ControlRequest& request);
  [[nodiscard]] std::string send_to_detector(const io::ControlRequest& request);
  [[nodiscard]] std::string begin_reload();
  /// An empty string while there is no answer.
  [[nodiscard]] std::string poll_loop_answer();
  [[nodiscard]] std::string poll_alarm_answer();
  [[nodiscard]] std::string poll_reload_answer();
  /// Audits the rejection of the current request and returns its answer.
  [[nodiscard]] std::string reject(const std::string& why);
  /// Writes the current command to the audit file.
  void audit(const std::string& reject_reason);
  [[nodiscard]] std::string explain(const control::CommandAnswer& answer) const;
  [[nodiscard]] std::string obstacle() const;
  [[nodiscard]] io::ControlStatus status() const;
  void add_rods(io::ControlStatus& status) const;
  /// Acknowledging a rod sensor's alarm readmits the sensor once its readings are right.
  void readmit_rods();
  [[nodiscard]] control::ArmingState state() const noexcept {
    return parts_.stats.state.load(std::memory_order_relaxed);
  }

  Parts parts_;
  Identity identity_;
  std::uint32_t number_ = 0;  ///< number of the newest command
  WaitsFor waits_for_ = WaitsFor::nothing;
  io::ControlSocket::Request request_{};  ///< the current one
  bool is_command_ = false;               ///< the request changes something
  bool acknowledges_rod_ = false;         ///< the request may acknowledge a rod sensor's alarm
  std::int64_t deadline_ns_ = 0;          ///< for the outstanding answer
};

}  // namespace monitor
