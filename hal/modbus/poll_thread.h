// Thread that polls a Modbus device, and its interface to the loop.
//
// The loop sets the pace: each command (or, without a valve, each reading) starts one round of
// requests, one at a time. The loop takes the latest readings. It stores a command in a slot
// without a system call: the thread predicts the next tick from earlier ones and checks then
// (poll_schedule.h).
//
//   - Nothing is written before the loop's first command.
//   - Any invalid or missing reply closes the connection. Reconnection follows after a growing
//     pause, then null is written first and the device's time-out second. A command issued before
//     the loss is never sent after it.
//   - A command older than two periods is replaced by null, and so is the last one when no new one
//     has come for 50 ms.
#pragma once

#include <semaphore.h>
#include <sys/types.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/latest.h"
#include "hal/modbus/command_slot.h"
#include "hal/modbus/connection.h"
#include "hal/modbus/counters.h"
#include "hal/modbus/poll_schedule.h"
#include "hal/modbus/register_map.h"
#include "hal/monotonic.h"
#include "hal/thread.h"

namespace hal::modbus {

[[nodiscard]] inline std::int64_t to_ns(double s) noexcept { return std::llround(s * 1e9); }

struct PollThreadConfig {
  ConnectionConfig connection;
  double period_s = 0.005;
  double null_V = 0.0;
  double watchdog_s = kMissing;   ///< written to the map's watchdog register
  bool combined = false;          ///< function 23
  double hand_over_s = 1e-4;      ///< longest delay until the thread sees a command
  double read_ahead_s = 0.0;      ///< lead over the loop's next period; 0: read after the write
  double stale_after_s = 0.0125;  ///< a write unconfirmed for that long has failed
  double longest_pause_s = 1.0;   ///< between two attempts to connect
  int priority = 0;               ///< in SCHED_FIFO where allowed; 0: the normal class
};

class PollThread {
 public:
  /// Takes an open connection; `first` holds the readings of the probe.
  PollThread(const PollThreadConfig& config, RegisterMap map,
             std::unique_ptr<Connection> connection, std::unique_ptr<Counters> counters,
             const RegisterSnapshot& first);
  /// Writes null last, if anything has been written.
  ~PollThread();
  PollThread(const PollThread&) = delete;
  PollThread& operator=(const PollThread&) = delete;

  // The loop's side.
  void pace(const Tick& tick) noexcept;
  [[nodiscard]] const RegisterSnapshot& newest() noexcept { return latest_.get(); }
  [[nodiscard]] bool online() const noexcept { return online_.load(std::memory_order_acquire); }
  Applied write(double u_V) noexcept;
  Applied go_null() noexcept { return command(null_bits_); }
  bool set_output(std::size_t index, bool on) noexcept;

  /// Null for good; sent directly when the thread does not send it in time. Async-signal-safe.
  Applied end_at_null() noexcept;

  [[nodiscard]] const RegisterMap& map() const noexcept { return map_; }
  [[nodiscard]] const Counters& counters() const noexcept { return *counters_; }

 private:
  Applied command(Bits bits) noexcept;
  /// Publishes the next tick's time; wakes the thread if it sleeps.
  void announce(std::int64_t now_ns) noexcept;

  // The thread's side.
  void step() noexcept;
  void wait_until(std::int64_t t_ns) noexcept;
  [[nodiscard]] std::int64_t next_ns() noexcept;
  /// Time of the next check for a command.
  [[nodiscard]] std::int64_t look_ns(std::int64_t now_ns) noexcept;
  void work(std::int64_t now_ns) noexcept;
  void reconnect() noexcept;
  void lost() noexcept;
  /// Writes null and the device's time-out. False when the connection has been lost.
  bool initialize_device() noexcept;
  void send(const RegisterCommand& command, std::int64_t now_ns) noexcept;
  bool write_bits(Bits bits) noexcept;
  /// Time of the last rod reading; 0: none.
  [[nodiscard]] std::int64_t measured() const noexcept;
  void write_outputs() noexcept;
  void read_blocks(std::size_t from) noexcept;
  void keep(std::size_t block, const std::uint16_t* words, std::int64_t t_ns) noexcept;
  /// The device answers with an exception: the values of the block are missing at once.
  void forget(std::size_t block) noexcept;
  void finish() noexcept;

  const PollThreadConfig config_;
  const RegisterMap map_;
  std::unique_ptr<Counters> counters_;
  std::unique_ptr<Connection> connection_;
  const std::int64_t period_ns_;
  const std::int64_t stale_ns_;
  const Bits null_bits_;
  const std::optional<std::size_t> rod_;  ///< index among the map's reads
  std::vector<std::uint8_t> null_frame_;

  // From the loop.
  CommandSlot slot_;
  sem_t wake_;
  std::atomic<bool> asleep_{false};  ///< the thread waits for a wake-up
  std::atomic<bool> paced_{false};
  std::atomic<bool> switched_{false};              ///< an output was set without a driven valve
  std::atomic<bool> driven_{false};                ///< the loop has issued a command
  std::atomic<bool> closing_{false};               ///< only null from now on
  std::atomic<std::int64_t> given_ns_{0};          ///< time of the newest command
  std::vector<std::atomic<std::int8_t>> outputs_;  ///< -1: nothing new
  std::int64_t announced_tick_ = -1;
  PollSchedule schedule_;
  std::atomic<std::int64_t> next_tick_ns_{0};  ///< start of the loop's next period

  // To the loop.
  Latest<RegisterSnapshot> latest_;
  std::atomic<bool> online_{true};
  /// Issue time of the newest command that the device confirmed.
  std::atomic<std::int64_t> taken_ns_{0};
  std::atomic<bool> null_taken_{false};  ///< confirmed after closing_ was set

  // The thread's own.
  std::atomic<bool> stop_{false};
  std::atomic<pid_t> thread_id_{0};
  RegisterSnapshot snapshot_;
  bool initialized_ = false;  ///< initialize_device() succeeded on this connection
  bool at_null_ = true;       ///< null was the last value written
  bool first_round_ = true;
  std::int64_t read_due_ns_ = kNever_ns;
  std::int64_t retry_ns_ = 0;
  std::int64_t pause_ns_ = 0;
  Thread thread_;
};

}  // namespace hal::modbus
