// The configured rig: the backend and channel of each role.
//
// TOML: `[rod] backend, channel`, `[[spare_rod]] id, backend, channel`, `[valve] backend, null_V,
// limit_V, slew_V_per_s`, `[[input]] id, role, backend, channel`, `[permit] backend, channel`, and
// one table for each backend that is used, named like it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/backend.h"

namespace hal {

/// One device of a backend, by channel name.
struct DeviceAddress {
  std::string backend;
  std::string channel;
};

struct ValveConfig {
  std::string backend = "none";
  double null_V = 0.0;
  double limit_V = 10.0;
  double slew_V_per_s = std::numeric_limits<double>::infinity();
  bool accept_no_hardware_watchdog = false;
};

/// TOML [[spare_rod]].
struct SpareRodConfig {
  std::string id;
  DeviceAddress device{"", kRodChannel};

  void visit(config::schema::Visitor& v);
};

/// TOML [[input]].
struct InputConfig {
  std::string id;
  std::string role = "other";
  DeviceAddress device;

  void visit(config::schema::Visitor& v);
};

/// Role of an input.
enum class InputRole : std::uint8_t {
  e_stop,           ///< 1 while the emergency stop is released; anything else trips
  enable,           ///< 1 while a person allows motion
  valve_command,    ///< V, the command of the controller in charge (monitor only)
  supply_pressure,  ///< Pa, and so are the next two; one of each at most
  pressure_in,      ///< chamber that extends the rod
  pressure_out,     ///< chamber that retracts it
  pressure,         ///< Pa, any other
  other
};

/// True for the pressures that accompany every sample.
[[nodiscard]] constexpr bool goes_with_samples(InputRole role) noexcept {
  return role == InputRole::supply_pressure || role == InputRole::pressure_in ||
         role == InputRole::pressure_out;
}

struct NamedInput {
  std::string id;
  InputRole role = InputRole::other;
  std::shared_ptr<Input> input;
};

struct NamedRod {
  std::string id;
  std::shared_ptr<RodSensor> rod;
};

/// Devices of all roles; nothing has been written yet.
struct Devices {
  std::shared_ptr<RodSensor> rod;
  std::vector<NamedRod> spare_rods;
  std::shared_ptr<ValveDrive> valve;  ///< null: the valve is never driven
  std::vector<NamedInput> inputs;
  std::shared_ptr<Output> permit;   ///< null when there is none
  double sample_time_s = kMissing;  ///< period dictated by a record, else NaN
  bool fast = false;                ///< run as fast as possible, independent of the wall clock
  /// One line of counters per backend that has any.
  std::vector<std::function<std::string()>> summaries;
};

class Rig {
 public:
  Rig();

  /// Visits the roles and the tables of the backends in use.
  void visit(config::schema::Visitor& v);
  /// Opens each backend once. Throws ConfigError for a backend or channel that does not exist or
  /// does not fit its role, DeviceUnavailable for a device that cannot be reached.
  [[nodiscard]] Devices open(const OpenContext& context) const;

  /// Opens the valve's backend alone; null where no valve is driven or it ends with its process.
  /// Throws as open().
  [[nodiscard]] std::shared_ptr<ValveDrive> open_valve(const OpenContext& context) const;

  [[nodiscard]] const std::string& rod_backend() const noexcept { return rod_.backend; }
  [[nodiscard]] const ValveConfig& valve() const noexcept { return valve_; }
  [[nodiscard]] const std::vector<SpareRodConfig>& spare_rods() const noexcept {
    return spare_rods_;
  }
  [[nodiscard]] const std::vector<InputConfig>& inputs() const noexcept { return inputs_; }
  [[nodiscard]] bool has_input(InputRole role) const;
  /// At least one of the pressures that accompany every sample.
  [[nodiscard]] bool measures_pressures() const;
  /// Number of rod sensors, the configured one included.
  [[nodiscard]] std::size_t rods() const noexcept { return 1 + spare_rods_.size(); }
  [[nodiscard]] bool has_permit() const noexcept { return permit_present_; }
  /// No device moves anything real.
  [[nodiscard]] bool harmless() const;
  /// Fastest rod speed under a held limit_V; NaN when unknown.
  [[nodiscard]] double worst_speed_mps(const OpenContext& context) const;
  /// Null times of the valve's backend.
  [[nodiscard]] NullTimes null_times() const;
  /// Longest age at which a position, e-stop or enable still counts.
  [[nodiscard]] double reading_hold_s(const OpenContext& context) const;
  /// The pressures that accompany every sample, then the notes of each backend in use.
  [[nodiscard]] std::vector<std::string> notes(const OpenContext& context) const;

 private:
  /// Throws ConfigError for two inputs of a role that must be unique.
  void check_inputs(const std::string& file) const;
  [[nodiscard]] const Backend* find(const std::string& name) const noexcept;
  /// Names of the backends in use, each once.
  [[nodiscard]] std::vector<std::string> used() const;

  DeviceAddress rod_{"sim", kRodChannel};
  std::vector<SpareRodConfig> spare_rods_;
  ValveConfig valve_;
  std::vector<InputConfig> inputs_;
  bool permit_present_ = false;
  DeviceAddress permit_{"", "permit"};
  std::vector<std::unique_ptr<Backend>> backends_;  ///< in the order of the registry
};

/// Names of all backends, for messages: "sim, replay".
[[nodiscard]] std::string backend_names();

}  // namespace hal
