// Orders from the control socket to the loop and the loop's answers back, one order at a time. Runs
// on the main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/control/refusal.h"
#include "daemon/io/control_messages.h"
#include "daemon/io/control_socket.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_stats.h"
#include "daemon/rt/queues.h"

namespace monitor {

class CommandDesk {
 public:
  /// What it works with; all of it outlives the desk.
  struct Parts {
    rt::Clock& clock;
    rt::CommandQueue& commands;
    const rt::LoopStats& stats;
  };
  /// What does not change.
  struct Identity {
    std::string rig_id, config_hash;
    std::vector<control::GuardConfig> guards;  ///< control::all_guards
    std::vector<std::string> spare_rods, inputs;
    std::vector<std::size_t> enables, e_stops;  ///< which of the inputs
    std::string never_arms;  ///< why it can never be armed as it is; empty when it can
  };

  CommandDesk(const Parts& parts, Identity identity);

  /// Takes some requests and gives answers; returns whether to come again soon: an order waits for
  /// the loop, or there are more requests.
  bool serve(io::ControlSocket& socket);

 private:
  [[nodiscard]] std::string line_for(const io::ControlRequest& request, bool may_act);
  [[nodiscard]] std::string take_answer(bool& answered) const;
  [[nodiscard]] std::string words(const control::Answer& answer) const;
  [[nodiscard]] std::string obstacle() const;
  [[nodiscard]] io::ControlStatus status() const;
  [[nodiscard]] control::State state() const noexcept {
    return parts_.stats.state.load(std::memory_order_relaxed);
  }

  Parts parts_;
  Identity identity_;
  std::uint32_t number_ = 0;  ///< of the newest order
  bool waiting_ = false;
  std::uint64_t client_ = 0;  ///< who waits
  std::int64_t until_ns_ = 0;
};

}  // namespace monitor
