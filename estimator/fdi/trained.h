// What `spoolwatch train` learns from records: the file that sources name as `file`.
//
// It is of one rig, sample time and units, and refused for any other. Each entry is of the values
// it was trained on, of their blocks, and of the settings of what makes these values, back to the
// sample: structure, offset, filter, window and so on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/fdi/alarm.h"
#include "estimator/fdi/detection_method_config.h"

namespace estimator::fdi {

/// Block means of one kind of records: healthy, or with one fault.
struct TrainedClass {
  std::string name;            ///< "healthy", or the parameter that has changed
  std::int64_t direction = 0;  ///< in which it has, 0 when that is not said
  std::int64_t blocks = 0;
  std::vector<double> mean;
  std::vector<double> covariance;  ///< row by row
  /// Standard deviations that count over long runs: autocorrelation of the blocks in them.
  std::vector<double> long_run;

  void visit(config::schema::Visitor& v);
};

/// [[trained]]: what one source needs.
struct TrainedMethod {
  std::string id;
  std::vector<std::string> quantities;
  /// Of the source of each quantity, then "|" and those of the sources that it reads; "" of the
  /// sample.
  std::vector<std::string> settings;
  double block_s = 0.0;
  std::vector<TrainedClass> classes;

  void visit(config::schema::Visitor& v);
  /// Null when there is none.
  [[nodiscard]] const TrainedClass* healthy() const noexcept;
};

struct TrainedFile {
  static constexpr std::int64_t kVersion = 2;
  static constexpr const char* kHealthy = "healthy";
  /// Of positions, commands and times, and so of all that is estimated from them.
  static constexpr const char* kUnits = "m, V, s";

  std::int64_t version = kVersion;
  std::string units = kUnits;
  std::string rig_id;
  double sample_time_s = 0.0;
  std::vector<std::string> records;
  std::vector<TrainedMethod> methods;

  void visit(config::schema::Visitor& v);
};

/// What a source that is trained is configured with.
struct TrainedMethodConfig : DetectionMethodConfig {
  double block_s = 0.0;
  std::string file;  ///< "" when the numbers stand in the configuration

  /// id, then block_s and file.
  void visit_trained(config::schema::Visitor& v);
  /// The quantities that it is trained on.
  [[nodiscard]] virtual std::vector<std::string> quantities() const = 0;
  /// Whether it needs classes other than healthy.
  [[nodiscard]] virtual bool needs_classes() const { return false; }
  virtual void adopt(const TrainedMethod& trained) = 0;
  [[nodiscard]] virtual const char* list() const = 0;

  [[nodiscard]] std::vector<std::string> inputs() const override { return quantities(); }
  void load(const ConfigLoadContext& context) override;
  [[nodiscard]] std::string where() const { return std::string("[[") + list() + "]] " + id; }

 private:
  /// Throws when `trained` was learned from other values than these.
  void check(const TrainedMethod& trained, const ConfigLoadContext& context,
             const std::string& place) const;
};

/// Settings of the source of each quantity, as they stand in a trained file. Throws
/// schema::ConfigError at `where` for a source that is trained itself.
[[nodiscard]] std::vector<std::string> settings_of(const std::vector<std::string>& quantities,
                                                   const PipelineConfig& pipeline,
                                                   const std::string& where);

/// How a source's own alarm is named; keys of its list.
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
