// A data acquisition board under comedi as a device: an analogue output drives the valve, analogue
// inputs read pressures or another controller's command, and an analogue input or a counter reads
// the rod.
//
// A D/A converter holds its last code when the process ends; the board itself does not return the
// valve to null.
#pragma once

#include <vector>

#include "hal/backend.h"
#include "hal/comedi/board.h"
#include "hal/freshness.h"

namespace hal::comedi {

/// TOML [comedi.output]: volts at the terminal = polarity * scale_ratio * command + offset_V.
struct OutputConfig {
  ChannelConfig channel;
  double scale_ratio = 1.0;  ///< V at the terminal per V of command
  double offset_V = 0.0;
  std::int64_t polarity = 1;

  void visit(config::schema::Visitor& v);
  [[nodiscard]] Linear terminal_V() const noexcept {
    return {static_cast<double>(polarity) * scale_ratio, offset_V};
  }
};

/// TOML [[comedi.input]]: value = offset + scale_per_V * volts, in the SI unit of its role.
struct ComediInputConfig {
  std::string name;
  ChannelConfig channel;
  double scale_per_V = 1.0;
  double offset = 0.0;

  void visit(config::schema::Visitor& v);
};

/// TOML [comedi.rod]: an analogue input, y = offset_m + scale_m_per_V * volts, or a counter,
/// y = offset_m + sign * resolution_m * counts since the start.
struct RodConfig {
  std::string kind = "analog";
  ChannelConfig channel;
  double scale_m_per_V = kMissing;
  double resolution_m = kMissing;
  double offset_m = 0.0;
  std::int64_t sign = 1;
  std::int64_t bits = 0;  ///< width of the counter; 0: as the board reports

  void visit(config::schema::Visitor& v);
};

/// TOML [comedi].
struct ComediConfig {
  std::string device = "/dev/comedi0";
  bool threaded = true;
  std::int64_t priority = 79;
  double delay_s = 0.0;
  double max_speed_mps = kMissing;
  bool bench_rig = false;
  bool has_output = false;
  OutputConfig output;
  bool has_rod = false;
  RodConfig rod;
  std::vector<ComediInputConfig> inputs;

  void visit(config::schema::Visitor& v);
  /// Checks across fields. `file` is for messages. Throws config::schema::ConfigError.
  void check(const std::string& file) const;
};

class ComediBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  /// True without an output: nothing moves.
  [[nodiscard]] bool harmless() const noexcept override {
    return !config_.has_output || config_.bench_rig;
  }
  [[nodiscard]] double worst_speed_mps(const OpenContext&, double) const override {
    return config_.has_output ? config_.max_speed_mps : 0.0;
  }
  [[nodiscard]] double reading_hold_s(const OpenContext& context) const override {
    return hal::reading_hold_s(context.sample_time_s);
  }
  /// The converter holds its last code for ever.
  [[nodiscard]] NullTimes null_times() const override { return {.latency_s = config_.delay_s}; }

 private:
  ComediConfig config_;
};

}  // namespace hal::comedi
