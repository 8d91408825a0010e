// The rig that the configuration names: which backend plays which role.
//
// TOML: `[rod] backend, channel`, `[[spare_rod]] id, backend, channel`,
// `[valve] backend, null_V, limit_V, slew_V_per_s`, `[[input]] id, role, backend, channel`,
// `[permit] backend, channel`, and one table for each backend that is used, named like it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/backend.h"

namespace hal {

/// One device of a backend: the name is the backend's own, or one of its table.
struct Place {
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
  Place place{"", kRodChannel};

  void visit(config::schema::Visitor& v);
};

/// TOML [[input]].
struct InputConfig {
  std::string id;
  std::string role = "other";
  Place place;

  void visit(config::schema::Visitor& v);
};

/// What an input is for.
enum class InputRole : std::uint8_t {
  e_stop,           ///< 1 while the emergency stop is released; anything else trips
  enable,           ///< 1 while a person allows motion
  valve_command,    ///< V, the command of the controller in charge (monitor only)
  supply_pressure,  ///< Pa, and so are the next two; one of each at most
  pressure_in,      ///< of the chamber that extends the rod
  pressure_out,     ///< of the chamber that retracts it
  pressure,         ///< Pa, any other
  other
};

/// One of the pressures that go with every sample.
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

/// All roles, filled; nothing has been written yet.
struct Devices {
  std::shared_ptr<RodSensor> rod;
  std::vector<NamedRod> spare_rods;
  std::shared_ptr<ValveDrive> valve;  ///< null: nothing is ever driven
  std::vector<NamedInput> inputs;
  std::shared_ptr<Output> permit;   ///< null when there is none
  double sample_time_s = kMissing;  ///< period that a record dictates, else NaN
  bool fast = false;                ///< as fast as possible: nothing waits for the wall clock
  /// One line of counters from each backend that has any.
  std::vector<std::function<std::string()>> summaries;
};

class Rig {
 public:
  Rig();

  /// Lists the roles and the tables of the backends that they name.
  void visit(config::schema::Visitor& v);
  /// Opens each backend once. Throws Error when one does not exist or does not do what is asked,
  /// DeviceUnavailable where a device cannot be reached.
  [[nodiscard]] Devices open(const Opening& opening) const;

  /// Opens the valve's backend alone; null where none is driven or it goes with its process. Throws
  /// Error.
  [[nodiscard]] std::shared_ptr<ValveDrive> open_valve(const Opening& opening) const;

  [[nodiscard]] const std::string& rod_backend() const noexcept { return rod_.backend; }
  [[nodiscard]] const ValveConfig& valve() const noexcept { return valve_; }
  [[nodiscard]] const std::vector<SpareRodConfig>& spare_rods() const noexcept {
    return spare_rods_;
  }
  [[nodiscard]] const std::vector<InputConfig>& inputs() const noexcept { return inputs_; }
  [[nodiscard]] bool has_input(InputRole role) const;
  /// At least one of those that go with every sample.
  [[nodiscard]] bool measures_pressures() const;
  /// Rod sensors, the configured one and the spare ones.
  [[nodiscard]] std::size_t rods() const noexcept { return 1 + spare_rods_.size(); }
  [[nodiscard]] bool has_permit() const noexcept { return permit_present_; }
  /// No device moves anything real.
  [[nodiscard]] bool harmless() const;
  /// Fastest rod under a held limit_V, NaN when it cannot be said.
  [[nodiscard]] double worst_speed_mps(const Opening& opening) const;
  /// Of the valve's backend.
  [[nodiscard]] NullTimes null_times() const;
  /// The pressures that go with every sample, and what every backend in use has to say.
  [[nodiscard]] std::vector<std::string> notes(const Opening& opening) const;

 private:
  /// Throws Error for a second input of a role that stands once.
  void check_inputs(const std::string& file) const;
  [[nodiscard]] const Backend* find(const std::string& name) const noexcept;
  /// Names of the backends in use, each once.
  [[nodiscard]] std::vector<std::string> used() const;

  Place rod_{"sim", kRodChannel};
  std::vector<SpareRodConfig> spare_rods_;
  ValveConfig valve_;
  std::vector<InputConfig> inputs_;
  bool permit_present_ = false;
  Place permit_{"", "permit"};
  std::vector<std::unique_ptr<Backend>> backends_;  ///< in the order of the registry
};

/// Names of all backends, as messages list them: "sim, replay".
[[nodiscard]] std::string backend_names();

}  // namespace hal
