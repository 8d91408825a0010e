// Fault detection, sample by sample: estimators over windows of (u, y) and other sources of values
// (source.h), and bands on what they find. No thread, no message, no device: the daemon, tests and
// off-line replay run this same code.
//
//   Pipeline pipeline(config, sample_time_s);
//   for (const Sample& s : record) pipeline.process(s, events);
//
// process() does not allocate once every window has been filled once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "config/signals/sample.h"
#include "estimator/fdi/alarm_book.h"
#include "estimator/fdi/band.h"
#include "estimator/fdi/quantity.h"
#include "estimator/fdi/source.h"

namespace estimator::fdi {

/// TOML [[estimator]]. Order of treatment: offset, filter, decimation, increments, de-trend.
struct EstimatorConfig {
  std::string id;
  std::string structure = "arx111";  ///< "arx211", "arx(2,1,1)"
  std::string method = "batch";      ///< batch (a tumbling window), sliding, recursive
  bool constant = false;             ///< estimate a constant term
  /// y minus its previous value takes the place of y: with structure arx011 the integrator's pole
  /// is fixed at 1 instead of estimated, which short windows need.
  bool increments = false;
  double window_s = 2.0;         ///< of recursive: over which excitation and gaps are judged
  double stride_s = 0.02;        ///< between estimates, of sliding and recursive
  double offset_m = 0.0;         ///< subtracted from y
  std::string detrend = "none";  ///< none, mean, linear: of each batch window, u and y alike
  std::string filter = "none";   ///< none, low, high, band: of u and y alike, before all else
  double filter_low_Hz = 0.0;    ///< lower edge, of high and band
  double filter_high_Hz = 0.0;   ///< upper edge, of low and band
  std::int64_t decimation = 1;   ///< keep one of so many samples, low-passed before
  double forgetting = 0.998;     ///< of recursive, per sample
  double prior_variance = 1e6;   ///< of recursive, P(0) = C I
  double first_batch_s = 0.0;    ///< of recursive: a first batch that starts it warm
  double warmup_s = 0.0;         ///< from the first sample: no band acts before
  double min_u_rms_V = 0.0;      ///< a window with less command than this is not excited
  double max_condition = 1e8;    ///< of the scaled regressors; beyond it INVALID
  double max_saturated = 0.1;    ///< greatest share of saturated samples in a window
  double max_missing = 0.05;     ///< greatest share of missing samples in a window

  void visit(config::schema::Visitor& v);
  /// One line with every setting that the values of the estimates depend on.
  [[nodiscard]] std::string fingerprint() const;
};

/// TOML: [[estimator]], [[band]], bands_file, and a list of each further kind of source.
struct PipelineConfig {
  /// `more`: kinds of sources besides source_kinds(), from code above this library.
  explicit PipelineConfig(std::span<const SourceKind> more);
  PipelineConfig() : PipelineConfig(std::span<const SourceKind>{}) {}

  std::vector<EstimatorConfig> estimators;
  std::vector<SourceList> sources;  ///< one list for each kind, estimators apart
  std::vector<BandConfig> bands;
  std::string bands_file;  ///< learned bands, "" for none; relative to the configuration's folder

  void visit(config::schema::Visitor& v);
  /// Adds to the list of that kind; the name is one of `sources`.
  void add(std::string_view list, std::unique_ptr<SourceConfig> source);
  /// Ids of estimators, then of the other sources, in their order.
  [[nodiscard]] std::vector<std::string> source_ids() const;
  /// Null when no source but perhaps an estimator has this id.
  [[nodiscard]] const SourceConfig* find_source(std::string_view id) const noexcept;
  /// The settings of the estimator or other source with this id, in one line; "" when there is
  /// none.
  [[nodiscard]] std::string fingerprint(std::string_view id) const;
  /// Whether a key "bands_file", "[[band]] id: high", "[[cusum]] id: ..." belongs to it.
  [[nodiscard]] bool owns(std::string_view key) const;

  /// Completes it with what stands in other files (relative to `folder`), so that nothing is left
  /// there. Of bands_file the limits go to the bands on the same quantity that give none, or else
  /// make a band of their own; they must have been learned at this sample time and with the same
  /// estimators. Other sources take in theirs (SourceConfig::load). Else schema::ConfigError.
  /// Call once, before Pipeline. `rig_id`: "" when it is not known.
  void load_bands(const std::filesystem::path& folder, double sample_time_s,
                  const std::string& rig_id = "");
};

/// What one source found; the pointers hold until the next call of process().
struct EstimateEvent {
  std::size_t estimator;    ///< number in PipelineConfig::source_ids(): estimators come first
  std::string_view source;  ///< its id
  std::int64_t tick;        ///< newest sample in it
  std::int64_t utc_us;
  bool valid;
  bool warming_up;          ///< within warmup_s or the first window: no alarm acts on it
  std::string_view reason;  ///< why not valid, "" when it is
  double condition;         ///< 2-norm condition number of the scaled regressors
  int samples;              ///< regressor rows used
  const NamedValue* begin_values;
  const NamedValue* end_values;
  [[nodiscard]] const NamedValue* begin() const noexcept { return begin_values; }
  [[nodiscard]] const NamedValue* end() const noexcept { return end_values; }
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(end_values - begin_values);
  }
  /// NaN when there is no such value.
  [[nodiscard]] double value(std::string_view name) const noexcept;
};

/// Receives what process() finds, on the calling thread.
class Events {
 public:
  virtual ~Events() = default;
  virtual void on_estimate(const EstimateEvent& event) = 0;
  /// An alarm's severity, direction or life changed.
  virtual void on_alarm(const Alarm& alarm) = 0;
};

class Pipeline {
 public:
  /// Throws schema::ConfigError for an unknown structure, quantity, double id, sources that
  /// read each other in a circle, ...
  Pipeline(const PipelineConfig& config, double sample_time_s);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  void process(const config::signals::Sample& sample, Events& events);
  /// Forgets all samples, as at a start; alarms go back to OK without an event.
  void reset();

  /// Saves every bit that later results depend on, or restores it into a pipeline of the same
  /// configuration and sample time, which then goes on exactly as the saved one would have. When
  /// archive.complete() is false afterwards, it is of no use.
  void serialize(StateArchive& archive);

  /// Takes the place of the pipeline before it between two samples: sources whose settings are the
  /// same, and those of the sources that they read, go on, the others warm up; bands and alarms
  /// that stay go on with their states (AlarmBook::inherit). Same sample time; before the first
  /// sample. Returns, for each of PipelineConfig::source_ids(), whether it goes on.
  std::vector<bool> inherit(Pipeline& before);

  /// Bands are in it from the start; conditions from elsewhere are set by the caller.
  [[nodiscard]] AlarmBook& alarms() noexcept;
  [[nodiscard]] const AlarmBook& alarms() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace estimator::fdi
