#include "hal/modbus/devices.h"

#include <cmath>
#include <utility>

#include "hal/modbus/jitter_check.h"

namespace hal::modbus {
namespace {

/// One value of the newest snapshot, with its quality.
class Channel {
 public:
  Channel(std::shared_ptr<PollThread> poll_thread, std::size_t index, const Freshness& freshness)
      : poll_thread_(std::move(poll_thread)),
        index_(index),
        stale_ns_(std::llround(freshness.stale_after_s * 1e9)),
        bad_ns_(std::llround(freshness.bad_after_s * 1e9)) {}

  /// Lets the poll thread follow the loop; once a tick, further calls do nothing.
  void pace(const Tick& tick) const noexcept { poll_thread_->pace(tick); }

  [[nodiscard]] InputReading newest() const noexcept {
    const RegisterSnapshot& snapshot = poll_thread_->newest();
    const ReadChannel& r = poll_thread_->map().reads[index_];
    InputReading reading;
    reading.t_ns = snapshot.t_ns[r.block];
    const std::int64_t age_ns = monotonic_ns() - reading.t_ns;
    const double value = snapshot.value[index_];
    if (!poll_thread_->online() || reading.t_ns == 0 || age_ns > bad_ns_ ||
        !r.codec.plausible(value)) {
      return reading;
    }
    reading.value = value;
    reading.quality =
        age_ns > stale_ns_ ? config::signals::Quality::stale : config::signals::Quality::good;
    return reading;
  }

 private:
  std::shared_ptr<PollThread> poll_thread_;
  std::size_t index_;
  std::int64_t stale_ns_;
  std::int64_t bad_ns_;
};

class ModbusInput final : public Input {
 public:
  explicit ModbusInput(Channel channel) : channel_(std::move(channel)) {}
  InputReading read(const Tick& tick) noexcept override {
    channel_.pace(tick);
    return channel_.newest();
  }

 private:
  Channel channel_;
};

class ModbusRod final : public RodSensor {
 public:
  ModbusRod(Channel position, std::unique_ptr<Channel> command, double jitter_s)
      : position_(std::move(position)),
        command_(std::move(command)),
        jitter_check_(std::llround(jitter_s * 1e9)) {}

  Reading read(const Tick& tick) noexcept override {
    position_.pace(tick);
    const InputReading position = position_.newest();
    Reading reading;
    reading.y_m = position.value;
    reading.t_ns = position.t_ns;
    reading.quality = position.quality;
    const bool in_phase = jitter_check_.accepts(position.t_ns, tick.nominal_ns);
    if (reading.quality == config::signals::Quality::good && !in_phase)
      reading.quality = config::signals::Quality::stale;
    if (command_ != nullptr) reading.command_V = command_->newest().value;
    return reading;
  }

 private:
  Channel position_;
  std::unique_ptr<Channel> command_;  ///< null: the device does not report it
  JitterCheck jitter_check_;
};

class ModbusValve final : public ValveDrive {
 public:
  explicit ModbusValve(std::shared_ptr<PollThread> poll_thread)
      : poll_thread_(std::move(poll_thread)) {}
  Applied write(double u_V, const Tick& tick) noexcept override {
    poll_thread_->pace(tick);  // the rod may be read by another backend
    return poll_thread_->write(u_V);
  }
  Applied go_null() noexcept override { return poll_thread_->go_null(); }
  Applied end_at_null() noexcept override { return poll_thread_->end_at_null(); }

 private:
  std::shared_ptr<PollThread> poll_thread_;
};

class ModbusOutput final : public Output {
 public:
  ModbusOutput(std::shared_ptr<PollThread> poll_thread, std::size_t index)
      : poll_thread_(std::move(poll_thread)), index_(index) {}
  bool set(bool on) noexcept override { return poll_thread_->set_output(index_, on); }

 private:
  std::shared_ptr<PollThread> poll_thread_;
  std::size_t index_;
};

}  // namespace

BackendDevices make_devices(const std::shared_ptr<PollThread>& poll_thread,
                            const Freshness& freshness, const std::string& label) {
  BackendDevices devices;
  const RegisterMap& map = poll_thread->map();
  const auto readback = map.find_role("valve_readback");
  for (std::size_t i = 0; i < map.reads.size(); ++i) {
    const ReadChannel& r = map.reads[i];
    const Channel channel(poll_thread, i, freshness);
    if (r.role == "rod") {
      auto command =
          readback ? std::make_unique<Channel>(poll_thread, *readback, freshness) : nullptr;
      devices.rods[r.name] =
          std::make_shared<ModbusRod>(channel, std::move(command), freshness.jitter_s);
    } else {
      devices.inputs[r.name] = std::make_shared<ModbusInput>(channel);
    }
  }
  for (std::size_t i = 0; i < map.outputs.size(); ++i) {
    devices.outputs[map.outputs[i].name] = std::make_shared<ModbusOutput>(poll_thread, i);
  }
  if (map.valve) devices.valve = std::make_shared<ModbusValve>(poll_thread);
  devices.summary = [poll_thread, label] {
    return label + ": " + summary(poll_thread->counters());
  };
  return devices;
}

}  // namespace hal::modbus
