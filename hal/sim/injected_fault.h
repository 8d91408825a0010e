// Scheduled faults of the simulated devices, and the simulated devices besides rod and valve: spare
// rod sensors, switches and an output. Pressure transducers are in plant_sim/transducer.h.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "config/schema/visitor.h"
#include "hal/device.h"

namespace hal::sim {

/// TOML [[sim.trouble]]: from_s <= t < to_s on the loop's grid.
struct InjectedFault {
  /// missing, frozen, jump, drift, stale (of a reading), or deaf (the valve ignores commands).
  std::string kind;
  std::string rod;  ///< id of a [[sim.rod]]; empty: the rig's own
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
  double size_m = 0.0;     ///< size of a jump
  double rate_mps = 0.0;   ///< rate of a drift
  std::string pressure{};  ///< transducer with the fault; empty: a rod sensor

  void visit(config::schema::Visitor& v);
  [[nodiscard]] bool at(double t_s) const noexcept { return t_s >= from_s && t_s < to_s; }
};

/// The faults of one sensor, however many, at the cost of those that are on.
class ScheduledFaults {
 public:
  explicit ScheduledFaults(std::vector<InjectedFault> faults) : faults_(std::move(faults)) {
    on_.reserve(faults_.size());
  }

  /// Calls `apply` for each fault that is on at t_s, in the order of the configuration.
  template <class Apply>
  void for_each(double t_s, Apply apply) noexcept {
    if (!(t_s >= since_s_ && t_s < until_s_)) look_up(t_s);
    for (const std::size_t i : on_) apply(faults_[i]);
  }

 private:
  void look_up(double t_s) noexcept;

  std::vector<InjectedFault> faults_;
  std::vector<std::size_t> on_;  ///< between since_s_ and until_s_
  double since_s_ = std::numeric_limits<double>::infinity();
  double until_s_ = 0.0;
};

/// Applies the faults of one rod sensor to its readings.
class FaultyRod {
 public:
  /// Selects the faults of sensor `id` from `all`; `id` empty: the rig's own sensor.
  FaultyRod(const std::vector<InjectedFault>& all, const std::string& id);

  /// Returns whether the valve ignores commands.
  bool apply(Reading& reading, double t_s) noexcept;

 private:
  ScheduledFaults faults_;
  double last_y_m_ = kMissing;  ///< reading before the freeze
};

/// Applies the faults of one pressure transducer to its readings.
class FaultyPressure {
 public:
  FaultyPressure(const std::vector<InjectedFault>& all, const std::string& id);
  void apply(InputReading& reading, double t_s) noexcept;

 private:
  ScheduledFaults faults_;
  double last_Pa_ = kMissing;  ///< reading before the freeze
};

/// TOML [[sim.rod]]: a spare sensor on the same rod, with its own resolution and noise.
struct SpareConfig {
  std::string id;
  double offset_m = 0.0;  ///< from from_s on
  double from_s = 0.0;
  double encoder_resolution_m = 0.0;
  double noise_m = 0.0;

  void visit(config::schema::Visitor& v);
};

/// TOML [[sim.input]]: reads `value`, and between from_s and to_s `meanwhile` or nothing.
struct SimSwitchConfig {
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
  explicit Switch(const SimSwitchConfig& config) noexcept
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
class CountingLine final : public Output {
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
