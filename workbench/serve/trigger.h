// A trigger looks for the moment at which a channel crosses a level, as that of an oscilloscope
// does, and says which span of time about the crossing is to be kept.
#pragma once

#include <optional>
#include <string>

namespace workbench::serve {

struct TriggerSettings {
  enum class Mode { off, normal, single };
  enum class Edge { rising, falling, either };

  Mode mode = Mode::off;
  std::string channel = "y";  ///< key of a LiveColumn
  Edge edge = Edge::rising;
  double level = 0.0;          ///< in the unit in which the page shows the channel
  double window_s = 2.0;       ///< length of a capture
  double before_ratio = 0.25;  ///< part of the window before the crossing
  double hold_off_s = 0.0;     ///< from the end of a capture until the next crossing counts

  static constexpr double kLongest_s = 20.0;
};

class Trigger {
 public:
  struct Span {
    double from_s, at_s, to_s;  ///< `at_s`: the crossing, between two samples
  };

  Trigger() = default;
  explicit Trigger(const TriggerSettings& settings) : settings_(settings) {}

  /// Takes the channel's next sample; NaN is a gap, over which nothing crosses. A span where a
  /// capture ends with this sample. Times ascend; after a clock that went back everything begins
  /// again.
  std::optional<Span> add(double t_s, double value);
  [[nodiscard]] const TriggerSettings& settings() const { return settings_; }
  /// "off", "waiting", "capturing", "held off" or "stopped" after a single capture.
  [[nodiscard]] const char* state() const;

 private:
  [[nodiscard]] bool crosses(double value) const;

  TriggerSettings settings_;
  std::optional<double> t_s_;      ///< of the newest sample
  double value_ = 0.0;             ///< NaN: a gap
  std::optional<Span> capturing_;  ///< until its end
  double held_off_until_s_ = 0.0;
  bool held_off_ = false, stopped_ = false;
};

[[nodiscard]] const char* to_string(TriggerSettings::Mode mode);
[[nodiscard]] const char* to_string(TriggerSettings::Edge edge);

}  // namespace workbench::serve
