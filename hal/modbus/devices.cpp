#include "hal/modbus/devices.h"

#include <cmath>
#include <utility>

#include "hal/modbus/phase.h"

namespace hal::modbus {
namespace {

/// One value of the newest snapshot, judged.
class Channel {
 public:
  Channel(std::shared_ptr<Link> link, std::size_t index, const Freshness& freshness)
      : link_(std::move(link)),
        index_(index),
        stale_ns_(std::llround(freshness.stale_after_s * 1e9)),
        bad_ns_(std::llround(freshness.bad_after_s * 1e9)) {}

  [[nodiscard]] InputReading read(const Tick& tick) const noexcept {
    link_->pace(tick);
    const Snapshot& snapshot = link_->newest();
    const ReadChannel& r = link_->plan().reads[index_];
    InputReading reading;
    reading.t_ns = snapshot.t_ns[r.block];
    const std::int64_t age_ns = monotonic_ns() - reading.t_ns;
    const double value = snapshot.value[index_];
    if (!link_->online() || reading.t_ns == 0 || age_ns > bad_ns_ || !r.codec.plausible(value)) {
      return reading;
    }
    reading.value = value;
    reading.quality =
        age_ns > stale_ns_ ? config::signals::Quality::stale : config::signals::Quality::good;
    return reading;
  }

 private:
  std::shared_ptr<Link> link_;
  std::size_t index_;
  std::int64_t stale_ns_;
  std::int64_t bad_ns_;
};

class ModbusInput final : public Input {
 public:
  explicit ModbusInput(Channel channel) : channel_(std::move(channel)) {}
  InputReading read(const Tick& tick) noexcept override { return channel_.read(tick); }

 private:
  Channel channel_;
};

class ModbusRod final : public RodSensor {
 public:
  ModbusRod(Channel position, std::unique_ptr<Channel> command, double jitter_s)
      : position_(std::move(position)),
        command_(std::move(command)),
        phase_(std::llround(jitter_s * 1e9)) {}

  Reading read(const Tick& tick) noexcept override {
    const InputReading position = position_.read(tick);
    Reading reading;
    reading.y_m = position.value;
    reading.t_ns = position.t_ns;
    reading.quality = position.quality;
    const bool in_phase = phase_.keeps(position.t_ns, tick.nominal_ns);
    if (reading.quality == config::signals::Quality::good && !in_phase)
      reading.quality = config::signals::Quality::stale;
    if (command_ != nullptr) reading.command_V = command_->read(tick).value;
    return reading;
  }

 private:
  Channel position_;
  std::unique_ptr<Channel> command_;  ///< null: the device does not tell
  Phase phase_;
};

class ModbusValve final : public ValveDrive {
 public:
  explicit ModbusValve(std::shared_ptr<Link> link) : link_(std::move(link)) {}
  Applied write(double u_V, const Tick& tick) noexcept override {
    link_->pace(tick);  // the rod may be read by another backend
    return link_->write(u_V);
  }
  Applied go_null() noexcept override { return link_->go_null(); }
  Applied end_at_null() noexcept override { return link_->end_at_null(); }

 private:
  std::shared_ptr<Link> link_;
};

class ModbusOutput final : public Output {
 public:
  ModbusOutput(std::shared_ptr<Link> link, std::size_t index)
      : link_(std::move(link)), index_(index) {}
  bool set(bool on) noexcept override { return link_->set_output(index_, on); }

 private:
  std::shared_ptr<Link> link_;
  std::size_t index_;
};

}  // namespace

Offer make_devices(const std::shared_ptr<Link>& link, const Freshness& freshness,
                   const std::string& label) {
  Offer offer;
  const Plan& plan = link->plan();
  const auto readback = plan.find_role("valve_readback");
  for (std::size_t i = 0; i < plan.reads.size(); ++i) {
    const ReadChannel& r = plan.reads[i];
    const Channel channel(link, i, freshness);
    if (r.role == "rod") {
      auto command = readback ? std::make_unique<Channel>(link, *readback, freshness) : nullptr;
      offer.rods[r.name] =
          std::make_shared<ModbusRod>(channel, std::move(command), freshness.jitter_s);
    } else {
      offer.inputs[r.name] = std::make_shared<ModbusInput>(channel);
    }
  }
  for (std::size_t i = 0; i < plan.outputs.size(); ++i) {
    offer.outputs[plan.outputs[i].name] = std::make_shared<ModbusOutput>(link, i);
  }
  if (plan.valve) offer.valve = std::make_shared<ModbusValve>(link);
  offer.summary = [link, label] { return label + ": " + summary(link->counters()); };
  return offer;
}

}  // namespace hal::modbus
