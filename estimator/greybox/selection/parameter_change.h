// A parameter that changes within a record, or from one record to another.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace estimator::greybox::selection {

enum class ChangeKind {
  step,
  ramp,         ///< linear over `duration_s`
  exponential,  ///< with the time constant `duration_s`, as in warming up
  record        ///< between records: in `record` it has another value than in the others
};
/// "step", "ramp", "exponential", "record".
[[nodiscard]] const char* to_string(ChangeKind kind);

struct ParameterChange {
  std::string parameter;  ///< "damping_N_s_per_m", "null_bias.offset_V"
  ChangeKind kind = ChangeKind::step;
  double at_s = 0.0;        ///< its beginning, in the record's time
  bool is_dated = false;    ///< `at_s` is estimated
  double duration_s = 0.0;  ///< 0 for a step
  double from = 0.0;
  double to = 0.0;
  // Standard errors; NaN where not known.
  double at_error_s = std::numeric_limits<double>::quiet_NaN();
  double from_error = std::numeric_limits<double>::quiet_NaN();
  double to_error = std::numeric_limits<double>::quiet_NaN();
  std::string record{};  ///< name of the record where it differs; empty: it changes within one
  /// Parameters whose change would explain the record about as well.
  std::vector<std::string> rivals{};
};

/// True where the value after a change is two standard errors from that before. A value at its
/// bound has no error: only zero is one to state. An error of the scale moves both values by their
/// ratio and does not count.
[[nodiscard]] bool is_clear_of_errors(const ParameterChange& change);

[[nodiscard]] inline bool changes_parameter(const std::vector<ParameterChange>& changes,
                                            const std::string& name) {
  return std::any_of(changes.begin(), changes.end(),
                     [&](const ParameterChange& change) { return change.parameter == name; });
}

/// True where a parameter of the effect is among those that change.
[[nodiscard]] inline bool changes_effect(const std::vector<ParameterChange>& changes,
                                         const std::string& effect) {
  return std::any_of(changes.begin(), changes.end(), [&](const ParameterChange& change) {
    return change.parameter.starts_with(effect + ".");
  });
}

}  // namespace estimator::greybox::selection
