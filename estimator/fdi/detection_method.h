// A detection method derives named values from the samples, from the values of other methods, or
// from both. Bands monitor any value of any method, so that all methods feed the same alarm rules;
// a method that names the fault itself declares alarms of its own beside them.
//
// For every sample, and for each method after those that it reads, a pipeline calls on_gap() when
// periods are missing, push(), and, where these report that an output is due, evaluate() and then
// alarm_input() for each declared alarm. None of these may allocate, block or throw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "config/signals/sample.h"
#include "estimator/fdi/alarm_book.h"
#include "estimator/fdi/detection_method_config.h"
#include "estimator/fdi/quantity.h"
#include "estimator/state_archive.h"

namespace estimator::fdi {

/// Holds for all values of one evaluation.
struct MethodOutput {
  bool valid = false;
  bool warming_up = false;  ///< no band and no declared alarm acts on the values
  const char* reason =
      "";  ///< reason of an invalid output; static, or owned by the method until its next call
  double condition = kNaN;
  int samples = 0;  ///< rows used
};

class DetectionMethod {
 public:
  DetectionMethod() = default;
  DetectionMethod(const DetectionMethod&) = delete;
  DetectionMethod& operator=(const DetectionMethod&) = delete;
  virtual ~DetectionMethod() = default;

  /// Names of the values, constant.
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// Alarms that the method sets itself, constant: name, rules, guidance, limits. The pipeline
  /// fills in source and quantity; an alarm without a parameter is named at run time.
  [[nodiscard]] virtual std::vector<Alarm> declared_alarms() const { return {}; }

  /// `periods` samples are missing before the next one; true when an output became due meanwhile.
  virtual bool on_gap(std::int64_t periods) noexcept = 0;
  /// Next sample; `y_m` is the position where it may be used, NaN otherwise. True when an output is
  /// due.
  virtual bool push(const config::signals::Sample& sample, double y_m) noexcept = 0;
  /// Sets value and std_error of each of `values`, which are in the order of names().
  virtual MethodOutput evaluate(std::span<EstimatedValue> values) noexcept = 0;
  /// Present input of the number-th of declared_alarms(); views hold until the next call. The
  /// pipeline sets the tick. AlarmInput::fault names the parameter and its ambiguity group.
  [[nodiscard]] virtual AlarmInput alarm_input(std::size_t /*number*/) const noexcept { return {}; }

  /// Back to the initial state.
  virtual void reset() = 0;
  /// Every bit that later values depend on (state_archive.h).
  virtual void serialize(StateArchive& archive) = 0;
  /// Between two outputs, s; NaN when they come irregularly.
  [[nodiscard]] virtual double interval_s() const noexcept { return kNaN; }
};

/// Ends a text that snprintf has truncated after a whole word, with "..."; `wanted`: the result of
/// snprintf.
void end_after_a_word(std::span<char> text, int wanted) noexcept;

/// The newest output of a method, as other methods read it.
struct OutputPort {
  static constexpr std::size_t kReason = 320;
  std::vector<EstimatedValue> values;
  MethodOutput output;        ///< output.reason points to `reason`
  char reason[kReason] = "";  ///< truncated after a whole word
  bool fresh = false;         ///< evaluated with the present sample
  double interval_s = kNaN;

  void reset() noexcept;
  void serialize(StateArchive& archive);
};

/// A value of another method, or of the sample.
class MethodInput {
 public:
  MethodInput(const OutputPort& port, std::size_t index) : port_(&port), index_(index) {}
  /// Evaluated with the present sample.
  [[nodiscard]] bool fresh() const noexcept { return port_->fresh; }
  /// The newest value may be used: valid, finite, warmed up.
  [[nodiscard]] bool usable() const noexcept;
  [[nodiscard]] bool warming_up() const noexcept { return port_->output.warming_up; }
  [[nodiscard]] const char* why() const noexcept;  ///< why not usable
  [[nodiscard]] double value() const noexcept { return port_->values[index_].value; }
  [[nodiscard]] double std_error() const noexcept { return port_->values[index_].std_error; }
  [[nodiscard]] double interval_s() const noexcept { return port_->interval_s; }

 private:
  const OutputPort* port_;
  std::size_t index_;
};

/// Finds values by name for a method under construction.
class InputResolver {
 public:
  virtual ~InputResolver() = default;
  /// "ESTIMATOR.b1", "sample.following_error_m"; valid for the pipeline's lifetime. Throws
  /// schema::ConfigError at `where` when there is no such value.
  [[nodiscard]] virtual MethodInput find(const std::string& quantity,
                                         const std::string& where) const = 0;
};

/// Environment that a method is made in.
struct MethodContext {
  double sample_time_s;
  const InputResolver&
      inputs;  ///< only quantities of DetectionMethodConfig::inputs(); do not keep the reference
};

}  // namespace estimator::fdi
