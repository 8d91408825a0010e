// The simulated rig as a device: a plant, an encoder, a D/A converter and a schedule of faults.
//
// It advances on the nominal time grid, whatever the wall clock did: reading at tick n integrates
// from the last tick read to n under the voltage written last. The same seed and the same sequence
// of ticks and writes give the same readings. With a command time-out the simulated valve goes to
// null by itself when nothing has been written for that long, also while the process stood still.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "hal/backend.h"
#include "hal/sim/injected_fault.h"
#include "plant_sim/instruments.h"
#include "plant_sim/schedule.h"
#include "plant_sim/transducer.h"

namespace hal::sim {

/// TOML [sim].
struct SimConfig : plant_sim::BenchPlant {
  double command_timeout_s = std::numeric_limits<double>::infinity();
  bool pretend_real = false;  ///< under the rules of a rig that moves something
  std::vector<InjectedFault> injected_faults;
  std::vector<SpareConfig> rods;
  std::vector<SimSwitchConfig> inputs;

  void visit(config::schema::Visitor& v);
};

class SimRig final : public RodSensor, public ValveDrive {
 public:
  /// Throws config::schema::Error when a fault names no parameter of the plant.
  SimRig(std::unique_ptr<plant_sim::Plant> plant, const SimConfig& config, double sample_time_s,
         double null_V);

  Reading read(const Tick& tick) noexcept override;
  Applied write(double u_V, const Tick& tick) noexcept override;
  Applied go_null() noexcept override;
  /// The plant's own position, after the tick read last.
  [[nodiscard]] double position_m() const noexcept { return plant_->reading_m(); }
  /// Likewise, its pressures.
  [[nodiscard]] config::signals::Pressures pressures() const noexcept {
    return plant_->pressures();
  }

 private:
  Applied take(double u_V) noexcept;

  std::unique_ptr<plant_sim::Plant> plant_;
  plant_sim::Schedule schedule_;
  plant_sim::Encoder encoder_;
  plant_sim::DacRange dac_;
  double sample_time_s_;
  double null_V_;
  std::atomic<double> held_V_;  ///< go_null() may come from another thread
  std::atomic<bool> valve_unresponsive_{false};
  std::atomic<std::int64_t> written_{0};  ///< tick of the last write
  std::int64_t index_ = 0;                ///< tick that the plant stands at
  std::int64_t timeout_ticks_;
  FaultyRod faulty_;
};

/// A spare sensor on the rod of a SimRig, to be read after it.
class SpareRod final : public RodSensor {
 public:
  /// `injected_faults`: of all sensors; `seed`: of the noise.
  SpareRod(std::shared_ptr<const SimRig> rig, const SpareConfig& config,
           const std::vector<InjectedFault>& injected_faults = {}, std::uint64_t seed = 1)
      : rig_(std::move(rig)),
        offset_m_(config.offset_m),
        from_s_(config.from_s),
        encoder_(config.encoder_resolution_m, config.noise_m, seed),
        faulty_(injected_faults, config.id) {}
  Reading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<const SimRig> rig_;
  double offset_m_, from_s_;
  plant_sim::Encoder encoder_;
  FaultyRod faulty_;
};

/// A pressure of a SimRig's plant, to be read after the rig.
class PressureInput final : public Input {
 public:
  /// `which` of plant_sim::kTransducers; `transducers` are shared by all of a rig.
  PressureInput(std::shared_ptr<const SimRig> rig,
                std::shared_ptr<plant_sim::Transducers> transducers, std::size_t which,
                const std::vector<InjectedFault>& injected_faults = {})
      : rig_(std::move(rig)),
        transducers_(std::move(transducers)),
        which_(which),
        faulty_(injected_faults, plant_sim::kTransducers.at(which)) {}
  InputReading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<const SimRig> rig_;
  std::shared_ptr<plant_sim::Transducers> transducers_;
  std::size_t which_;
  FaultyPressure faulty_;
};

class SimBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  [[nodiscard]] bool harmless() const noexcept override { return !config_.pretend_real; }
  [[nodiscard]] bool outlives_process() const noexcept override { return false; }
  /// The simulated valve ends with the process, unless it pretends to be a real one.
  [[nodiscard]] NullTimes null_times() const override;
  [[nodiscard]] double worst_speed_mps(const OpenContext& context, double limit_V) const override;

 private:
  [[nodiscard]] std::unique_ptr<plant_sim::Plant> load(const OpenContext& context) const;
  void check_injected_faults(const OpenContext& context) const;
  /// Offers the pressures that the plant has.
  void add_pressures(const std::string& file, const std::shared_ptr<SimRig>& rig,
                     BackendDevices& devices) const;

  SimConfig config_;
};

}  // namespace hal::sim
