// Internals of Pipeline, for its own files only.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "estimator/fdi/detection_method.h"
#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {

/// A band and its alarm.
struct BandMonitor {
  BandState state;
  std::size_t alarm;  ///< number in the book
};

struct MonitoredValue {
  double value;
  double std_error;
  bool trusted;
  bool expected;    ///< false: the rig rests, and a value cannot be had
  const char* why;  ///< reason of an untrusted value
  std::int64_t tick;
};

struct MethodSlot {
  std::size_t number;  ///< in PipelineConfig::method_ids()
  std::string id;
  std::unique_ptr<DetectionMethod> method;
  std::unique_ptr<OutputPort> port;
  std::string settings;            ///< fingerprint, then those of the methods that this one reads
  std::vector<std::string> names;  ///< names of the values
  std::vector<std::vector<BandMonitor>> monitors;  ///< for each value
  std::vector<std::size_t> declared_alarms;        ///< numbers in the book
};

struct SampleBandMonitor {
  std::size_t quantity;  ///< number in kSampleQuantities
  BandMonitor monitor;
};

struct Pipeline::Impl final : private InputResolver {
  std::vector<MethodSlot> slots;  ///< in order of evaluation: each after its inputs
  OutputPort sample;              ///< the present sample's own quantities
  std::vector<SampleBandMonitor> sample_monitors;
  AlarmBook book;
  double sample_time_s = 0.0;
  bool started = false;
  bool at_rest = false;  ///< as the newest sample says
  std::int64_t last_tick = 0;

  Impl(const PipelineConfig& config, double sample_time);
  void add_methods(const PipelineConfig& config);
  void add(std::size_t number, const std::string& id, std::unique_ptr<DetectionMethod> method,
           std::string settings);
  void add(const BandConfig& band);
  void update_sample(const config::signals::Sample& next);
  void evaluate(MethodSlot& slot, std::int64_t tick, std::int64_t utc_us, Events& events);
  void monitor_band(BandMonitor& monitor, const MonitoredValue& value, Events& events);
  [[nodiscard]] MethodSlot* slot(std::string_view id) noexcept;
  /// Indices of the slot (slots.size(): the sample) and of the value. Throws schema::Error at
  /// `where` for an unknown value.
  [[nodiscard]] std::pair<std::size_t, std::size_t> locate(const std::string& quantity,
                                                           const std::string& where) const;
  [[nodiscard]] MethodInput find(const std::string& quantity,
                                 const std::string& where) const override;
  template <class F>
  void for_each_monitor(F&& f) {
    for (MethodSlot& slot : slots) {
      for (std::vector<BandMonitor>& monitors : slot.monitors) {
        for (BandMonitor& monitor : monitors) f(monitor);
      }
    }
    for (SampleBandMonitor& each : sample_monitors) f(each.monitor);
  }
};

}  // namespace estimator::fdi
