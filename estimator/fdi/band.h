// A band on a named quantity, as declared and as learned.
//
// The alarm is raised when the quantity has been outside [low, high] for on_delay_s, and returns
// when the quantity has been inside [low + hysteresis, high - hysteresis] for off_delay_s. low,
// high and hysteresis are in the quantity's unit.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/fdi/alarm.h"

namespace estimator::fdi {

/// TOML [[band]].
struct BandConfig {
  std::string id;
  std::string quantity;  ///< "ESTIMATOR.b1", "sample.y_m", ...: see quantity.h
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double hysteresis = 0.0;
  double on_delay_s = 0.0;
  double off_delay_s = 0.0;
  /// Time without a usable value before the alarm becomes INVALID; the last state holds until then.
  double invalid_delay_s = 0.0;
  std::string severity = "major";
  std::string parameter;
  bool falls_with_parameter = false;  ///< the quantity falls when the parameter rises
  std::vector<std::string> ambiguity_group;
  std::string guidance;
  AlarmRules rules;

  void visit(config::schema::Visitor& v);
};

/// State machine of one band on (value, time); knows no name and no alarm book.
class BandState {
 public:
  explicit BandState(const BandConfig& config);

  struct Result {
    Severity severity = Severity::ok;
    int direction = 0;  ///< -1 below, +1 above, 0 neither
  };
  /// Value at time t_s; NaN counts as untrustworthy.
  Result update(double value, double t_s) noexcept;
  /// Untrustworthy value at time t_s.
  Result update_invalid(double t_s) noexcept;
  /// No value is expected now: INVALID ends, a value that was outside stays so.
  Result rest() noexcept;
  void reset() noexcept;
  /// Takes over the state of another band, with own limits and delays.
  void inherit(const BandState& before) noexcept;

 private:
  [[nodiscard]] int wanted(double value) const noexcept;
  [[nodiscard]] Result result() const noexcept;

  double low_, high_, hysteresis_;
  double on_delay_s_, off_delay_s_, invalid_delay_s_;
  Severity alarm_;
  bool invalid_ = false;
  int direction_ = 0;  ///< kept while invalid
  int pending_ = 0;    ///< direction of the value, if different
  double pending_since_s_ = 0.0;
  bool missing_ = false;
  double missing_since_s_ = 0.0;
};

}  // namespace estimator::fdi
