// The simulated rig in real time: each request passes the time, and the plant is advanced to it
// under the voltage held at the valve.
//
// The voltage is the command's after the D/A converter, or the device's own null while no command
// has come for the time-out, the e-stop is pressed, or the permit is missing. The plant sees it
// through the wiring: u = valve_sign valve_scale u_converter. The reading is encoder_sign
// encoder_scale y + encoder_offset, before the encoder's steps. Faults by schedule count from the
// first command.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/hil_rig/rig_config.h"
#include "plant_sim/instruments.h"
#include "plant_sim/plant.h"
#include "plant_sim/schedule.h"

namespace hal::hil_rig {

enum Status : std::uint16_t {
  kCommanded = 1,
  kTimedOut = 2,
  kEStopPressed = 4,
  kPermitMissing = 8,
  kNotEnabled = 16
};

class BenchRig {
 public:
  /// Throws config::schema::ConfigError.
  BenchRig(const RigConfig& config, std::int64_t now_ns);

  /// Advances to `now_ns`, the time of all functions below; times do not go back.
  void advance_to(std::int64_t now_ns);

  void command(double u_V);
  void permit(bool on);
  void set_timeout(double timeout_s) { field_.command_timeout_s = timeout_s; }

  /// Encoder reading with a fresh sample of its noise.
  double read_position_m();
  /// Reading of a pressure transducer (index in plant_sim::kTransducers), likewise; NaN: none.
  double read_pressure_Pa(std::size_t which);
  [[nodiscard]] std::int32_t counts(double position_m) const;
  [[nodiscard]] double converter_V() const;
  [[nodiscard]] double asked_V() const noexcept { return asked_V_; }
  [[nodiscard]] double timeout_s() const noexcept { return field_.command_timeout_s; }
  [[nodiscard]] std::uint16_t status() const;
  [[nodiscard]] bool e_stop_released() const noexcept { return e_stop_ != 0.0; }
  [[nodiscard]] bool enabled() const noexcept { return enable_ != 0.0; }
  [[nodiscard]] std::uint32_t time_us() const;
  /// The rod's true position and speed.
  [[nodiscard]] const plant_sim::Plant& plant() const noexcept { return *plant_; }
  /// True while requests stay unanswered.
  [[nodiscard]] bool mute() const noexcept {
    return now_ns_ >= mute_from_ns_ && now_ns_ < mute_until_ns_;
  }

  /// "name=value" or "name=xFACTOR" (of the value at the start): a parameter of the plant, or
  /// e_stop, enable, mute_s (no answers, from 0.1 s later), encoder_frozen, valve_sign,
  /// valve_scale, encoder_sign, encoder_scale, encoder_offset_m, null_V, command_timeout_s,
  /// permit_timeout_s. Returns "" or what is wrong.
  std::string set(std::string_view text);

 private:
  struct Own {
    const char* name;
    double* value;
    double min;
    double max;
    double at_start;
  };

  [[nodiscard]] std::int64_t deadline_ns(double timeout_s, std::int64_t last_ns) const;
  /// Advances the plant under the held voltage.
  void hold_until(std::int64_t t_ns);
  [[nodiscard]] bool timed_out(std::int64_t t_ns) const;
  [[nodiscard]] bool permit_missing(std::int64_t t_ns) const;

  FieldConfig field_;
  std::unique_ptr<plant_sim::Plant> plant_;
  plant_sim::Schedule schedule_;
  plant_sim::Encoder encoder_;
  plant_sim::Transducers transducers_;
  plant_sim::DacRange dac_;
  double count_m_;
  double e_stop_ = 1.0;
  double enable_ = 1.0;
  double frozen_ = 0.0;
  double mute_s_ = 0.0;
  std::vector<Own> own_;
  std::vector<double> plant_at_start_;  ///< in the order of the plant's names

  std::int64_t start_ns_;
  std::int64_t now_ns_;
  std::int64_t steps_ = 0;           ///< done since the start
  std::int64_t schedule_steps_ = 0;  ///< steps since the first command
  std::int64_t command_ns_ = -1;     ///< time of the newest command; -1: none came
  std::int64_t permit_ns_ = -1;
  std::int64_t mute_from_ns_ = 0;
  std::int64_t mute_until_ns_ = 0;
  bool permit_on_ = false;
  double asked_V_;
  double last_position_m_ = 0.0;
};

}  // namespace hal::hil_rig
