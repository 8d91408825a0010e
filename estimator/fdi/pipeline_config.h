// Configuration of the fault detection: [[estimator]], [[band]], bands_file, and a list of each
// further kind of detection method.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/fdi/band.h"
#include "estimator/fdi/detection_method_config.h"

namespace estimator::fdi {

/// TOML [[estimator]]. Processing order: offset, filter, decimation, increments, de-trend.
struct EstimatorConfig {
  std::string id;
  std::string structure = "arx111";  ///< "arx211", "arx(2,1,1)"
  std::string method = "batch";      ///< batch (a tumbling window), sliding, recursive
  bool constant = false;             ///< estimate a constant term
  /// Replace y by its increment: with structure arx011 the integrator's pole is fixed at 1 instead
  /// of estimated, which short windows need.
  bool increments = false;
  double window_s = 2.0;         ///< recursive: horizon of the excitation and gap checks
  double stride_s = 0.02;        ///< between estimates; sliding and recursive
  double offset_m = 0.0;         ///< subtracted from y
  std::string detrend = "none";  ///< none, mean, linear: of u and y in each batch window
  std::string filter = "none";   ///< none, low, high, band: of u and y, as the first step
  double filter_low_Hz = 0.0;    ///< lower edge; high and band
  double filter_high_Hz = 0.0;   ///< upper edge; low and band
  std::int64_t decimation = 1;   ///< keep every n-th sample, low-passed before
  double forgetting = 0.998;     ///< recursive, per sample
  double prior_variance = 1e6;   ///< recursive, P(0) = C I
  double first_batch_s = 0.0;    ///< recursive: an initial batch gives the start values
  double warmup_s = 0.0;         ///< from the first sample; no band acts before
  double min_u_rms_V = 0.0;      ///< a window with less command is not excited
  double max_condition = 1e8;    ///< limit of the scaled regressors' condition; above it INVALID
  double max_saturated = 0.1;    ///< greatest share of saturated samples in a window
  double max_missing = 0.05;     ///< greatest share of missing samples in a window

  void visit(config::schema::Visitor& v);
  /// One line with every setting that affects the estimates.
  [[nodiscard]] std::string fingerprint() const;
};

struct PipelineConfig {
  /// `more`: kinds of methods besides detection_method_kinds(), from code above this library.
  explicit PipelineConfig(std::span<const DetectionMethodKind> more);
  PipelineConfig() : PipelineConfig(std::span<const DetectionMethodKind>{}) {}

  std::vector<EstimatorConfig> estimators;
  std::vector<DetectionMethodList> methods;  ///< one list for each kind, estimators apart
  std::vector<BandConfig> bands;
  std::string bands_file;  ///< learned bands, "" for none; relative to the configuration's folder

  void visit(config::schema::Visitor& v);
  /// Adds to the list of that kind; the name is one of `methods`.
  void add(std::string_view list, std::unique_ptr<DetectionMethodConfig> method);
  /// Ids of the estimators, then of the other methods, in configuration order.
  [[nodiscard]] std::vector<std::string> method_ids() const;
  /// Null when no method, estimators apart, has this id.
  [[nodiscard]] const DetectionMethodConfig* find_method(std::string_view id) const noexcept;
  /// Settings of the estimator or other method with this id in one line; "" for an unknown id.
  [[nodiscard]] std::string fingerprint(std::string_view id) const;
  /// True when a key "bands_file", "[[band]] id: high", "[[cusum]] id: ..." belongs here.
  [[nodiscard]] bool owns(std::string_view key) const;

  /// Merges the content of other files (relative to `folder`) into this configuration. The limits
  /// in bands_file apply to the bands on the same quantity that give none, or else add a band; they
  /// must have been learned at this sample time and with the same estimators. Other methods read
  /// their own files (DetectionMethodConfig::load). Throws schema::ConfigError. Call once,
  /// before Pipeline. `rig_id`: "" when unknown.
  void load_bands(const std::filesystem::path& folder, double sample_time_s,
                  const std::string& rig_id = "");
};

}  // namespace estimator::fdi
