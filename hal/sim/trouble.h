// What may go wrong with the simulated devices, on schedule, and the devices besides rod and valve:
// spare rod sensors, switches and an output; pressure transducers are plant_sim/transducer.h.
#pragma once

#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "hal/device.h"

namespace hal::sim {

/// TOML [[sim.trouble]]: from_s <= t < to_s on the loop's grid.
struct Trouble {
  /// Of a rod's reading: missing, frozen, jump, drift, stale; of the valve: deaf.
  std::string kind;
  std::string rod;  ///< id of a [[sim.rod]]; empty: the rig's own
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
  double size_m = 0.0;     ///< of a jump
  double rate_mps = 0.0;   ///< of a drift
  std::string pressure{};  ///< whose readings are missing, frozen or stale; empty: a rod's

  void visit(config::schema::Visitor& v);
  [[nodiscard]] bool at(double t_s) const noexcept { return t_s >= from_s && t_s < to_s; }
};

/// What the troubles of one rod sensor make of its readings.
class SpoiltRod {
 public:
  /// Those of `all` that are its own; `id` empty: the rig's own sensor.
  SpoiltRod(const std::vector<Trouble>& all, const std::string& id);

  /// Returns whether the valve is deaf.
  bool spoil(Reading& reading, double t_s) noexcept;

 private:
  std::vector<Trouble> troubles_;
  double last_y_m_ = kMissing;  ///< reading before the trouble that froze it
};

/// What the troubles of one pressure transducer make of its readings.
class SpoiltPressure {
 public:
  SpoiltPressure(const std::vector<Trouble>& all, const std::string& id);
  void spoil(InputReading& reading, double t_s) noexcept;

 private:
  std::vector<Trouble> troubles_;
  double last_Pa_ = kMissing;  ///< reading before the trouble that froze it
};

/// TOML [[sim.rod]]: a spare sensor on the same rod, with steps and noise of its own.
struct SpareConfig {
  std::string id;
  double offset_m = 0.0;  ///< from from_s on
  double from_s = 0.0;
  double encoder_resolution_m = 0.0;
  double noise_m = 0.0;

  void visit(config::schema::Visitor& v);
};

/// TOML [[sim.input]]: reads `value`, and from from_s to to_s `meanwhile` or nothing at all.
struct SwitchConfig {
  std::string id;
  double value = 1.0;
  double from_s = std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  double meanwhile = 0.0;
  bool missing = false;

  void visit(config::schema::Visitor& v);
};

class Switch final : public Input {
 public:
  explicit Switch(const SwitchConfig& config) noexcept
      : value_(config.value),
        from_s_(config.from_s),
        to_s_(config.to_s),
        meanwhile_(config.meanwhile),
        missing_(config.missing) {}
  InputReading read(const Tick& tick) noexcept override;

 private:
  double value_, from_s_, to_s_, meanwhile_;
  bool missing_;
};

/// A line whose edges are counted.
class Line final : public Output {
 public:
  bool set(bool on) noexcept override {
    if (on_.exchange(on, std::memory_order_relaxed) != on) {
      edges_.fetch_add(1, std::memory_order_relaxed);
    }
    return true;
  }
  [[nodiscard]] std::int64_t edges() const noexcept {
    return edges_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<bool> on_{false};
  std::atomic<std::int64_t> edges_{0};
};

}  // namespace hal::sim
