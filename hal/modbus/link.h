// The thread that talks to a Modbus device, and what the loop sees of it.
//
// The loop paces it: each command (or, where nothing is driven, each reading) that the loop asks
// for lets the thread do one round of requests, one at a time. The loop takes what was read last.
// It leaves a command in a box and makes no system call: the thread knows from the calls of before
// when the next tick comes, and looks then (rhythm.h).
//
//   - Nothing is written before the loop's first command.
//   - Whatever goes wrong with a reply closes the connection. It is made again after a growing
//     pause; null is the first thing written then, the device's time-out the second. A command that
//     was given before is never sent after.
//   - A command older than two periods is replaced by null, and so is the last one when the loop
//     has given none for 50 ms.
#pragma once

#include <semaphore.h>
#include <sys/types.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/device_thread.h"
#include "hal/latest.h"
#include "hal/modbus/counters.h"
#include "hal/modbus/mailbox.h"
#include "hal/modbus/plan.h"
#include "hal/modbus/port.h"
#include "hal/modbus/rhythm.h"

namespace hal::modbus {

[[nodiscard]] inline std::int64_t to_ns(double s) noexcept { return std::llround(s * 1e9); }

struct LinkConfig {
  PortConfig port;
  double period_s = 0.005;
  double null_V = 0.0;
  double watchdog_s = kMissing;   ///< written to the plan's watchdog register
  bool combined = false;          ///< function 23
  double hand_over_s = 1e-4;      ///< longest that a command waits for the thread to look
  double read_ahead_s = 0.0;      ///< how long before the loop's next period; 0: after the write
  double stale_after_s = 0.0125;  ///< a write not taken for that long has failed
  double longest_pause_s = 1.0;   ///< between two attempts to connect
  int priority = 0;               ///< of SCHED_FIFO, where it is allowed; 0: the normal class
};

class Link {
 public:
  /// Takes a connected port; the first snapshot is what was read while it was checked.
  Link(const LinkConfig& config, Plan plan, std::unique_ptr<Port> port,
       std::unique_ptr<Counters> counters, const Snapshot& first);
  /// Null is the last thing written, if anything was.
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // The loop's side.
  void pace(const Tick& tick) noexcept;
  [[nodiscard]] const Snapshot& newest() noexcept { return latest_.get(); }
  [[nodiscard]] bool online() const noexcept { return online_.load(std::memory_order_acquire); }
  Applied write(double u_V) noexcept;
  Applied go_null() noexcept { return command(null_bits_); }
  bool set_output(std::size_t index, bool on) noexcept;

  /// Null for good, sent past the thread when the thread does not do it in time. Async-signal-safe.
  Applied end_at_null() noexcept;

  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  [[nodiscard]] const Counters& counters() const noexcept { return *counters_; }

 private:
  Applied command(Bits bits) noexcept;
  /// Says when to look next; wakes the thread where it has given up looking.
  void announce(std::int64_t now_ns) noexcept;

  // The thread's side.
  void step() noexcept;
  void wait_until(std::int64_t t_ns) noexcept;
  [[nodiscard]] std::int64_t next_ns() noexcept;
  /// When to look for what the loop wants next.
  [[nodiscard]] std::int64_t look_ns(std::int64_t now_ns) noexcept;
  void work(std::int64_t now_ns) noexcept;
  void reconnect() noexcept;
  void lost() noexcept;
  /// Null and the device's time-out. False when the connection has been lost.
  bool greet() noexcept;
  void send(const Command& command, std::int64_t now_ns) noexcept;
  bool write_bits(Bits bits) noexcept;
  /// When the rod was read last, 0: never.
  [[nodiscard]] std::int64_t measured() const noexcept;
  void write_outputs() noexcept;
  void read_blocks(std::size_t from) noexcept;
  void keep(std::size_t block, const std::uint16_t* words, std::int64_t t_ns) noexcept;
  void finish() noexcept;

  const LinkConfig config_;
  const Plan plan_;
  std::unique_ptr<Counters> counters_;
  std::unique_ptr<Port> port_;
  const std::int64_t period_ns_;
  const std::int64_t stale_ns_;
  const Bits null_bits_;
  const std::optional<std::size_t> rod_;  ///< index among the plan's reads
  std::vector<std::uint8_t> null_frame_;

  // From the loop.
  CommandBox box_;
  sem_t wake_;
  std::atomic<bool> asleep_{false};  ///< the thread does not look by itself
  std::atomic<bool> paced_{false};
  std::atomic<bool> switched_{false};              ///< an output was set while nothing is driven
  std::atomic<bool> driven_{false};                ///< the loop has given a command
  std::atomic<bool> closing_{false};               ///< only null from now on
  std::atomic<std::int64_t> given_ns_{0};          ///< when the newest command was given
  std::vector<std::atomic<std::int8_t>> outputs_;  ///< -1: nothing new
  std::int64_t paced_tick_ = -1;
  Rhythm rhythm_;
  std::atomic<std::int64_t> next_tick_ns_{0};  ///< when the loop's next period will begin

  // To the loop.
  Latest<Snapshot> latest_;
  std::atomic<bool> online_{true};
  /// When the newest command that the device took was given.
  std::atomic<std::int64_t> taken_ns_{0};
  std::atomic<bool> null_taken_{false};  ///< after closing_ was seen

  // The thread's own.
  std::atomic<bool> stop_{false};
  std::atomic<pid_t> thread_id_{0};
  Snapshot snapshot_;
  bool greeted_ = false;  ///< null has been written on this connection
  bool at_null_ = true;   ///< what was written last
  bool first_round_ = true;
  std::int64_t read_due_ns_ = kNever_ns;
  std::int64_t retry_ns_ = 0;
  std::int64_t pause_ns_ = 0;
  DeviceThread thread_;
};

}  // namespace hal::modbus
