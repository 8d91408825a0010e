// Orders from the control socket to the loop, on alarms to the detector, and their answers back,
// one order at a time. Runs on the main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/control/reject_reason.h"
#include "daemon/detection/alarm_command_queue.h"
#include "daemon/detection/detectability_monitor.h"
#include "daemon/detection/rod_alarms.h"
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
  /// What it works with; all of it outlives the desk.
  struct Parts {
    rt::Clock& clock;
    rt::CommandQueue& commands;
    const rt::LoopStats& stats;
    detection::AlarmCommandQueue* alarm_commands =
        nullptr;  ///< null, as `alarm_answers`: none are taken
    detection::AlarmAnswerQueue* alarm_answers = nullptr;
    io::Audit* audit = nullptr;
    Reloader* reloader = nullptr;  ///< null: nothing is read again
    const detection::DetectabilityMonitor* detectability = nullptr;
  };
  /// What does not change.
  struct Identity {
    std::string rig_id, config_hash;
    std::vector<control::GuardConfig> guards;  ///< control::all_guards
    std::vector<std::string> spare_rods, inputs;
    std::vector<std::size_t> enables, e_stops;  ///< which of the inputs
    std::string never_arms;  ///< why it can never be armed as it is; empty when it can
  };

  ControlRequestHandler(const Parts& parts, Identity identity);

  /// Takes some requests and gives answers; returns whether to come again soon: an order waits for
  /// the loop or the detector, or there are more requests.
  bool serve(io::ControlSocket& socket);

 private:
  enum class WaitsFor : std::uint8_t { nothing, loop, detector, reloader };

  /// Empty: the answer comes from the loop or the detector.
  [[nodiscard]] std::string line_for(const io::ControlRequest& request);
  [[nodiscard]] std::string send_to_loop(const io::ControlRequest& request);
  [[nodiscard]] std::string send_to_detector(const io::ControlRequest& request);
  [[nodiscard]] std::string begin_reload();
  /// Empty: not yet.
  [[nodiscard]] std::string poll_loop_answer();
  [[nodiscard]] std::string poll_alarm_answer();
  [[nodiscard]] std::string poll_reload_answer();
  /// The answer that refuses the request at hand.
  [[nodiscard]] std::string reject(const std::string& why);
  /// Writes down the act at hand.
  void audit(const std::string& reject_reason);
  [[nodiscard]] std::string words(const control::Answer& answer) const;
  [[nodiscard]] std::string obstacle() const;
  [[nodiscard]] io::ControlStatus status() const;
  void add_rods(io::ControlStatus& status) const;
  /// Whoever has seen that a rod sensor is out lets it be in again, if it is right.
  void readmit_rods();
  [[nodiscard]] control::State state() const noexcept {
    return parts_.stats.state.load(std::memory_order_relaxed);
  }

  Parts parts_;
  Identity identity_;
  std::uint32_t number_ = 0;  ///< of the newest order
  WaitsFor waits_for_ = WaitsFor::nothing;
  io::ControlSocket::Request request_{};  ///< at hand
  bool acts_ = false;                     ///< it does more than look
  bool request_acknowledges_ = false;     ///< that a rod sensor is out, perhaps
  std::int64_t until_ns_ = 0;
};

}  // namespace monitor
