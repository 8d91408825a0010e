#include "hal/encoder/encoder.h"

#include <fmt/format.h>

#include <cstring>

#include "config/schema/error.h"
#include "hal/encoder/gpio_chip.h"

namespace hal::encoder {
namespace {

class SwitchInput final : public Input {
 public:
  SwitchInput(std::shared_ptr<EncoderWatch> watch, std::size_t index) noexcept
      : watch_(std::move(watch)), index_(index) {}

  InputReading read(const Tick&) noexcept override {
    const EncoderWatch::View& view = watch_->view();
    const int value = view.inputs[index_];
    const config::signals::Quality quality = watch_->quality(view.inputs_ns, monotonic_ns());
    if (value < 0 || quality == config::signals::Quality::bad)
      return {kMissing, view.inputs_ns, config::signals::Quality::bad};
    return {static_cast<double>(value), view.inputs_ns, quality};
  }

 private:
  std::shared_ptr<EncoderWatch> watch_;
  std::size_t index_;
};

class SwitchOutput final : public Output {
 public:
  explicit SwitchOutput(std::shared_ptr<GpioLine> line) noexcept : line_(std::move(line)) {}
  bool set(bool on) noexcept override { return line_->set(on); }

 private:
  std::shared_ptr<GpioLine> line_;
};

std::string summary(const EncoderSnapshot& rod) {
  std::string line = fmt::format(
      "encoder: {} edges; count uncertain {} times ({} illegal, {} overflows, {} disagreements, {} "
      "bursts), too fast {} times, {} index slips",
      rod.edges, rod.times_lost, rod.illegal, rod.overflows, rod.disagreements, rod.bursts,
      rod.times_too_fast, rod.slips);
  return line;
}

}  // namespace

EncoderWatch::EncoderWatch(std::unique_ptr<EdgeSource> source,
                           std::vector<std::shared_ptr<GpioLine>> inputs,
                           const TrackerOptions& options, std::int64_t period_ns, int priority)
    : source_(std::move(source)),
      inputs_(std::move(inputs)),
      period_ns_(period_ns),
      tracker_(options, still_levels(*source_)) {
  view_.inputs.fill(-1);
  pass();
  const int error = thread_.start_cyclic("encoder", {priority, -1, false}, [this] { pass(); });
  if (error != 0) {
    throw config::schema::RunError(std::string("encoder: no thread: ") + std::strerror(error));
  }
}

void EncoderWatch::pass() noexcept {
  const std::int64_t half_ns = period_ns_ / 2;
  tracker_.step(*source_, view_.inputs_ns == 0 ? 0 : half_ns, monotonic_ns);
  if (refer_.exchange(false, std::memory_order_relaxed)) tracker_.refer();
  view_.rod = tracker_.snapshot();
  if (view_.rod.alive_ns - view_.inputs_ns >= half_ns) {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      view_.inputs[i] = static_cast<std::int8_t>(inputs_[i]->value());
    }
    view_.inputs_ns = view_.rod.alive_ns;
  }
  latest_.put(view_);
}

Reading EncoderRod::read(const Tick&) noexcept {
  const EncoderSnapshot& rod = watch_->view().rod;
  const std::int64_t now_ns = monotonic_ns();
  Reading reading;
  reading.t_ns = rod.alive_ns;
  reading.quality =
      rod.failed ? config::signals::Quality::bad : watch_->quality(rod.alive_ns, now_ns);
  if (reading.quality == config::signals::Quality::bad) return reading;
  reading.y_m = reference_m_ + count_m_ * static_cast<double>(rod.counts);
  if (reading.quality == config::signals::Quality::stale) return reading;
  reading.t_ns = now_ns;  // had there been an edge since, the count would be newer
  reading.quality = rod.lost || rod.too_fast || !rod.homed ? config::signals::Quality::uncertain
                                                           : config::signals::Quality::good;
  return reading;
}

BackendDevices EncoderBackend::open(const OpenContext& context) const {
  config_.check(context.file);
  const std::string table = context.file + ": [encoder] ";
  const std::shared_ptr<GpioChip> chip = GpioChip::open(table + "chip", config_.chip);
  const Wiring wiring{false, config_.bias};
  const auto edges = [&](const char* key, std::int64_t line) {
    return chip->request(table + key, line, Use::edges, wiring);
  };
  std::shared_ptr<GpioLine> a = edges("line_a", config_.line_a);
  std::shared_ptr<GpioLine> b = edges("line_b", config_.line_b);
  std::shared_ptr<GpioLine> index =
      config_.line_index < 0 ? nullptr : edges("line_index", config_.line_index);
  std::vector<std::shared_ptr<GpioLine>> inputs;
  for (const GpioSwitchConfig& item : config_.inputs) {
    inputs.push_back(chip->request(table + "input \"" + item.name + "\" line", item.line,
                                   Use::input, item.wiring));
  }
  BackendDevices devices;
  for (const GpioSwitchConfig& item : config_.outputs) {
    devices.outputs[item.name] = std::make_shared<SwitchOutput>(
        chip->request(table + "output \"" + item.name + "\" line", item.line,
                      context.exclusive ? Use::output : Use::claim, item.wiring));
  }
  const TrackerOptions options{config_.per_cycle(), config_.max_edges_per_s, index != nullptr};
  const auto watch = std::make_shared<EncoderWatch>(
      std::make_unique<GpioSource>(std::move(a), std::move(b), std::move(index)), std::move(inputs),
      options, static_cast<std::int64_t>(context.sample_time_s * 1e9),
      static_cast<int>(config_.priority));
  devices.rods[kRodChannel] = std::make_shared<EncoderRod>(
      watch, static_cast<double>(config_.sign) * config_.count_m(), config_.reference_m);
  for (std::size_t i = 0; i < config_.inputs.size(); ++i) {
    devices.inputs[config_.inputs[i].name] = std::make_shared<SwitchInput>(watch, i);
  }
  devices.summary = [watch] { return summary(watch->view().rod); };
  return devices;
}

std::vector<std::string> EncoderBackend::notes(const OpenContext&) const {
  return {fmt::format(
      "encoder: {:.4g} um per count ({}), {:.0f} edges/s sustained: permitted speed {:.4g} m/s, "
      "uncertain from {:.4g} m/s",
      config_.count_m() * 1e6, config_.mode, config_.max_edges_per_s, config_.permitted_speed_mps(),
      kWarnRatio * config_.permitted_speed_mps())};
}

}  // namespace hal::encoder
