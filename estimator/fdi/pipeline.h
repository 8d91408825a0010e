// Fault detection, sample by sample: detection methods (detection_method.h), and bands on their
// values. No thread, message or device: the daemon, tests and off-line replay run this same code.
//
//   Pipeline pipeline(config, sample_time_s);
//   for (const Sample& s : record) pipeline.process(s, events);
//
// process() does not allocate once every window has been filled once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "config/signals/sample.h"
#include "estimator/fdi/alarm_book.h"
#include "estimator/fdi/pipeline_config.h"
#include "estimator/fdi/quantity.h"

namespace estimator::fdi {

/// Output of one method; the pointers hold until the next call of process().
struct EstimateEvent {
  std::size_t estimator;    ///< number in PipelineConfig::method_ids(): estimators come first
  std::string_view source;  ///< the method's id
  std::int64_t tick;        ///< newest sample used
  std::int64_t utc_us;
  bool valid;
  bool warming_up;          ///< within warmup_s or the first window: no alarm acts
  std::string_view reason;  ///< why not valid, "" when valid
  double condition;         ///< 2-norm condition number of the scaled regressors
  int samples;              ///< regressor rows used
  const EstimatedValue* begin_values;
  const EstimatedValue* end_values;
  [[nodiscard]] const EstimatedValue* begin() const noexcept { return begin_values; }
  [[nodiscard]] const EstimatedValue* end() const noexcept { return end_values; }
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(end_values - begin_values);
  }
  /// NaN when no such value exists.
  [[nodiscard]] double value(std::string_view name) const noexcept;
};

/// Receives the results of process(), on the calling thread.
class Events {
 public:
  virtual ~Events() = default;
  virtual void on_estimate(const EstimateEvent& event) = 0;
  /// An alarm's severity, direction or state changed.
  virtual void on_alarm(const Alarm& alarm) = 0;
};

class Pipeline {
 public:
  /// Throws schema::ConfigError for an unknown structure or quantity, a duplicate id, methods
  /// that read each other in a circle, ...
  Pipeline(const PipelineConfig& config, double sample_time_s);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  void process(const config::signals::Sample& sample, Events& events);
  /// Back to the initial state; alarms return to OK without an event.
  void reset();

  /// Saves every bit that later results depend on, or restores it into a pipeline of the same
  /// configuration and sample time, which then continues exactly as the saved one would have. The
  /// pipeline is unusable when archive.complete() is false afterwards.
  void serialize(StateArchive& archive);

  /// Replaces the pipeline `before` between two samples: methods with unchanged settings, their own
  /// and those of the methods that they read, continue, the others warm up; bands and alarms that
  /// stay keep their states (AlarmBook::inherit). Same sample time; before the first sample.
  /// Returns, for each of PipelineConfig::method_ids(), whether it continues.
  std::vector<bool> inherit(Pipeline& before);

  /// Holds the bands from the start; the caller sets conditions from elsewhere.
  [[nodiscard]] AlarmBook& alarms() noexcept;
  [[nodiscard]] const AlarmBook& alarms() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace estimator::fdi
