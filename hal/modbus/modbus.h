// Devices on Modbus, TCP or a serial line (libmodbus). TOML:
//
//   [modbus]
//   address = "192.168.0.7:502"       # or: serial = "/dev/ttyS0", baud, parity, stop_bits
//   unit = 1
//   combined = true                   # function 23: command and position in one transaction
//   watchdog_s = 0.05                 # the device goes to its null without a command for so long
//   [modbus.registers.position]      # NAME is the channel by which [rod], [[input]] ... name it
//   role = "rod"                      # valve_command, valve_readback, input, output, watchdog
//   address = 4
//   type = "float32"
// Requests run in a separate thread (poll_thread.h); registers.h and register_map.h define what a
// map may hold. A reading is good while it is fresh; stale when it is older than stale_after_s, is
// a repetition, or was measured further than jitter_s from its usual moment of the period; bad when
// it is older than bad_after_s, out of its limits, answered with an exception, or while there is no
// connection.
#pragma once

#include <vector>

#include "hal/backend.h"
#include "hal/modbus/poll_thread.h"
#include "hal/modbus/registers.h"

namespace hal::modbus {

/// TOML [modbus].
struct ModbusConfig {
  std::string address;
  std::string serial;
  std::int64_t baud = 19200;
  std::string parity = "even";
  std::int64_t stop_bits = 1;
  std::int64_t unit = 1;
  double timeout_s = kMissing;  ///< limit for a reply; NaN: 0.8 periods
  double connect_timeout_s = 0.2;
  double longest_pause_s = 1.0;
  double stale_after_s = kMissing;  ///< NaN: 2.5 periods
  double bad_after_s = kMissing;    ///< NaN: twice stale_after_s
  double jitter_s = kMissing;       ///< NaN: 0.1 periods
  bool combined = false;
  bool multiple_only = false;
  double read_ahead_s = 0.0;
  double hand_over_s = 1e-4;
  double watchdog_s = kMissing;
  double delay_s = 0.0;
  double max_speed_mps = kMissing;
  bool bench_rig = false;
  std::int64_t priority = 70;
  std::vector<Register> registers;

  void visit(config::schema::Visitor& v);
};

class ModbusBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  /// Connects and reads every register once; see poll_thread.h for what happens then.
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  /// Only when the configuration says that the other side is a simulated rig.
  [[nodiscard]] bool harmless() const noexcept override { return config_.bench_rig; }
  [[nodiscard]] double worst_speed_mps(const OpenContext&, double) const override {
    return config_.max_speed_mps;
  }
  /// The device's own time-out ends a command, whichever side has gone.
  [[nodiscard]] NullTimes null_times() const override {
    return {.bus_lost_s = config_.watchdog_s,
            .process_dead_s = config_.watchdog_s,
            .latency_s = config_.hand_over_s + config_.delay_s};
  }
  [[nodiscard]] double reading_hold_s(const OpenContext& context) const override;
  [[nodiscard]] std::vector<std::string> notes(const OpenContext& context) const override;

 private:
  [[nodiscard]] PollThreadConfig poll_thread_config(const OpenContext& context) const;
  void check(const OpenContext& context, const PollThreadConfig& poll,
             const RegisterMap& map) const;

  ModbusConfig config_;
};

}  // namespace hal::modbus
