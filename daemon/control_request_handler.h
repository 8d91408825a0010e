// Forwards requests from the control socket: commands to the loop, alarm commands to the detector,
// reloads to the reloader, and returns their answers. Each of the three has one request at a time:
// a command to the loop never waits for the detector. Runs on the main thread.
#pragma once

#include <cstdint>
#include <optional>
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
    std::vector<std::string> roles;             ///< one per input, as in the configuration
    std::vector<std::size_t> enables, e_stops;  ///< indices into `inputs`
    std::string never_arms;  ///< why the rig cannot be armed as configured; empty: it can
  };

  ControlRequestHandler(const Parts& parts, Identity identity);

  /// Handles a bounded number of requests. Returns true when more work is pending: an outstanding
  /// answer or further requests.
  bool serve(io::ControlSocket& socket);

 private:
  /// A request that another thread answers.
  struct Pending {
    io::ControlSocket::Request request;
    bool is_command = false;        ///< the request changes something
    bool acknowledges_rod = false;  ///< the request may acknowledge a rod sensor's alarm
    std::uint32_t number = 0;       ///< the command's
    std::int64_t deadline_ns = 0;
  };
  using Outstanding = std::optional<Pending>;

  /// True when the thread that answers such a request is free.
  [[nodiscard]] bool accepts(const io::ControlRequest& request) const noexcept;
  /// Returns the answers that have come.
  void poll_answers(io::ControlSocket& socket);
  /// The answer, or an empty string when another thread will provide it.
  [[nodiscard]] std::string handle(const io::ControlSocket::Request& request);
  [[nodiscard]] std::string send_to_loop(const Pending& pending);
  [[nodiscard]] std::string send_to_detector(const Pending& pending);
  [[nodiscard]] std::string begin_reload(const Pending& pending);
  /// An empty string while there is no answer.
  [[nodiscard]] std::string poll_loop_answer(const Pending& pending);
  [[nodiscard]] std::string poll_alarm_answer(const Pending& pending);
  [[nodiscard]] std::string poll_reload_answer(const Pending& pending);
  /// Audits the rejection of a request and returns its answer.
  [[nodiscard]] std::string reject(const Pending& pending, const std::string& why);
  /// Writes a command to the audit file.
  void audit(const Pending& pending, const std::string& reject_reason);
  [[nodiscard]] std::string explain(const control::CommandAnswer& answer,
                                    const Pending& pending) const;
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
  std::uint32_t number_ = 0;  ///< the newest command's
  Outstanding loop_;
  Outstanding detector_;
  Outstanding reloader_;
};

}  // namespace monitor
