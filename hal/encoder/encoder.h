// An incremental encoder on lines of a GPIO chip, and switches and relays on others of its lines.
//
// A separate thread blocks on the edges; the loop's read is wait-free and returns the current
// count. Inputs are read by the same thread, at least every half period. Outputs are set by the
// loop itself: a chip behind a bus (an I2C expander) is unsuitable for outputs.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "hal/backend.h"
#include "hal/encoder/gpio_chip.h"
#include "hal/encoder/tracker.h"
#include "hal/freshness.h"
#include "hal/latest.h"
#include "hal/monotonic.h"
#include "hal/thread.h"

namespace hal::encoder {

/// TOML [[encoder.input]] and [[encoder.output]].
struct GpioSwitchConfig {
  std::string name;
  std::int64_t line = -1;
  Wiring wiring;

  void visit(config::schema::Visitor& v);
};

/// TOML [encoder].
struct EncoderConfig {
  std::string chip;
  std::int64_t line_a = -1;
  std::int64_t line_b = -1;
  std::int64_t line_index = -1;
  std::string bias = "as_is";
  std::string mode = "x4";
  double resolution_m = kMissing;      ///< length of one count; or the next
  double counts_per_metre = kMissing;  ///< 1/m
  std::int64_t sign = 1;
  double reference_m = 0.0;  ///< position at the index, or without an index at the start
  double max_speed_mps = kMissing;
  double max_edges_per_s = 20'000.0;
  std::int64_t priority = 85;
  std::vector<GpioSwitchConfig> inputs;
  std::vector<GpioSwitchConfig> outputs;

  void visit(config::schema::Visitor& v);
  /// Checks across fields. `file` is for messages. Throws config::schema::ConfigError.
  void check(const std::string& file) const;
  [[nodiscard]] int per_cycle() const noexcept { return mode[1] - '0'; }
  /// Rod travel per count.
  [[nodiscard]] double count_m() const noexcept;
  [[nodiscard]] double edges_per_metre() const noexcept { return 4.0 / (per_cycle() * count_m()); }
  [[nodiscard]] double permitted_speed_mps() const noexcept {
    return max_edges_per_s / edges_per_metre();
  }
};

/// State that one thread reads, for a rod sensor and any number of inputs.
class EncoderWatch {
 public:
  static constexpr std::size_t kInputs = 16;

  /// Starts the thread. `period_ns`: of the loop. Throws config::schema::RunError when it
  /// cannot.
  EncoderWatch(std::unique_ptr<EdgeSource> source, std::vector<std::shared_ptr<GpioLine>> inputs,
               const TrackerOptions& options, std::int64_t period_ns, int priority);

  struct View {
    EncoderSnapshot rod;
    std::int64_t inputs_ns = 0;
    std::array<std::int8_t, kInputs> inputs{};  ///< 0, 1, or -1
  };
  /// Newest view; call from one thread only.
  const View& view() noexcept { return latest_.get(); }
  /// Makes the present position the origin within a period. Any thread.
  void refer() noexcept { refer_.store(true, std::memory_order_relaxed); }
  /// Quality of the state that was complete at `t_ns`.
  [[nodiscard]] config::signals::Quality quality(std::int64_t t_ns,
                                                 std::int64_t now_ns) const noexcept {
    return freshness(now_ns - t_ns, period_ns_);
  }

 private:
  void pass() noexcept;

  std::unique_ptr<EdgeSource> source_;
  std::vector<std::shared_ptr<GpioLine>> inputs_;
  std::int64_t period_ns_;
  Tracker tracker_;
  View view_;
  Latest<View> latest_;
  std::atomic<bool> refer_{false};
  Thread thread_;
};

class EncoderRod final : public RodSensor {
 public:
  EncoderRod(std::shared_ptr<EncoderWatch> watch, double count_m, double reference_m) noexcept
      : watch_(std::move(watch)), count_m_(count_m), reference_m_(reference_m) {}

  /// Present y; uncertain while edges may be missing, before the index, or near the permitted
  /// speed.
  Reading read(const Tick& tick) noexcept override;
  /// Error counters and edge rate; loop thread only.
  [[nodiscard]] const EncoderSnapshot& snapshot() noexcept { return watch_->view().rod; }

 private:
  std::shared_ptr<EncoderWatch> watch_;
  double count_m_;  ///< negative for a reversed encoder
  double reference_m_;
};

class EncoderBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  /// True: an encoder moves nothing.
  [[nodiscard]] bool harmless() const noexcept override { return true; }
  [[nodiscard]] double worst_speed_mps(const OpenContext&, double) const override { return 0.0; }
  [[nodiscard]] double reading_hold_s(const OpenContext& context) const override {
    return hal::reading_hold_s(context.sample_time_s);
  }
  [[nodiscard]] std::vector<std::string> notes(const OpenContext& context) const override;

 private:
  EncoderConfig config_;
};

}  // namespace hal::encoder
