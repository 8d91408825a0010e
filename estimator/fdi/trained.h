// Result of `spoolwatch train`: the file that detection methods name as `file`.
//
// Valid for one rig, sample time and set of units, and refused for any other. Each entry states the
// quantities that were trained on, their blocks, and the settings of the methods behind them, down
// to the sample: structure, offset, filter, window and so on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/fdi/alarm.h"
#include "estimator/fdi/detection_method_config.h"

namespace estimator::fdi {

/// Block means of one class of records: healthy, or with one fault.
struct TrainedClass {
  std::string name;            ///< "healthy", or the parameter that has changed
  std::int64_t direction = 0;  ///< direction of the change; 0: not stated
  std::int64_t blocks = 0;
  std::vector<double> mean;
  std::vector<double> covariance;  ///< row by row
  /// Long-run standard deviations, which include the autocorrelation of the blocks.
  std::vector<double> long_run;

  void visit(config::schema::Visitor& v);
};

/// Two sample times are the same within clock accuracy.
inline constexpr double kSameSampleTime_ratio = 1e-3;

/// [[trained]]: training result of one method.
struct TrainedMethod {
  std::string id;
  std::vector<std::string> quantities;
  /// Settings of the method behind each quantity, then "|" and those of the methods that it reads;
  /// "" for the sample.
  std::vector<std::string> settings;
  double block_s = 0.0;
  std::vector<TrainedClass> classes;

  void visit(config::schema::Visitor& v);
  /// The healthy class; null when there is none.
  [[nodiscard]] const TrainedClass* healthy() const noexcept;
};

struct TrainedFile {
  static constexpr std::int64_t kVersion = 2;
  static constexpr const char* kHealthy = "healthy";
  /// Units of positions, commands and times, and so of all estimates.
  static constexpr const char* kUnits = "m, V, s";

  std::int64_t version = kVersion;
  std::string units = kUnits;
  std::string rig_id;
  double sample_time_s = 0.0;
  std::vector<std::string> records;
  std::vector<TrainedMethod> methods;

  void visit(config::schema::Visitor& v);
};

/// Configuration of a trained method.
struct TrainedMethodConfig : DetectionMethodConfig {
  double block_s = 0.0;
  std::string file;  ///< "" when the configuration holds the numbers

  /// id, then block_s and file.
  void visit_trained(config::schema::Visitor& v);
  /// Quantities for the training.
  [[nodiscard]] virtual std::vector<std::string> quantities() const = 0;
  /// True when the method needs classes other than healthy.
  [[nodiscard]] virtual bool needs_classes() const { return false; }
  virtual void adopt(const TrainedMethod& trained) = 0;
  [[nodiscard]] virtual const char* list() const = 0;

  [[nodiscard]] std::vector<std::string> inputs() const override { return quantities(); }
  void load(const ConfigLoadContext& context) override;
  [[nodiscard]] std::string where() const { return std::string("[[") + list() + "]] " + id; }

 private:
  /// Throws when `trained` was learned from other quantities or settings.
  void check(const TrainedMethod& trained, const ConfigLoadContext& context,
             const std::string& place) const;
};

/// Settings of the method behind each quantity, as in a trained file. Throws
/// schema::ConfigError at `where` for a trained method.
[[nodiscard]] std::vector<std::string> settings_of(const std::vector<std::string>& quantities,
                                                   const PipelineConfig& pipeline,
                                                   const std::string& where);

/// Severity, guidance and rules of a method's own alarm; keys of its list.
struct AlarmNaming {
  std::string severity = "major";
  std::string guidance;
  AlarmRules rules;
  void visit(config::schema::Visitor& v);
  [[nodiscard]] Severity level() const {
    return severity == "minor" ? Severity::minor : Severity::major;
  }
  [[nodiscard]] Alarm alarm(std::string name) const;
};

}  // namespace estimator::fdi
