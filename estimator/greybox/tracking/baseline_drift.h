// Drift of the baseline: changes too slow to be faults, such as damping that falls while oil and
// seals warm up. The healthy value of a parameter follows the windows no faster than a stated rate
// and no further than a stated distance from the learned value.
//
//   h += min(max(g (x - h), -r T), r T),   h0 - below <= h <= h0 + above
//
// h  healthy value that changes are counted from, search units     h0  learned value
// x  estimate of an explained window without a named change of it  g   kGain, against chance
// T  time since the latest window that determined x                r   rate
// below above  the stated distance m: for a ratio -ln(1 - m) and ln(1 + m), else m
//
// A change faster than r is named before the baseline follows it; the baseline then stops
// following.
// Drift beyond the stated distance raises an alarm of its own.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/tracking/change_detector.h"
#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_result.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

/// Ratios to the healthy value; for an effect's parameter to its typical size.
struct DriftSettings {
  std::vector<std::string> parameters;  ///< names of tracked parameters
  double ratio_per_h = 0.5;
  double most_ratio = 0.3;
};

class BaselineDrift {
 public:
  static constexpr double kGain = 0.2;

  /// Throws config::schema::ConfigError that begins with `where` for a parameter that is not
  /// tracked.
  BaselineDrift(const ParameterSet& set, const DriftSettings& following,
                const std::string& where = "follow");

  /// theta of every parameter of the healthy rig.
  void take(const Eigen::VectorXd& learnt);
  /// One window. `explained`: by the model, with or without motion.
  void follow(const WindowResult& window, bool explained, const ChangeDetector& detector,
              Eigen::VectorXd& baseline);

  [[nodiscard]] std::size_t size() const noexcept { return followed_.size(); }
  /// Index of the tracked parameter.
  [[nodiscard]] std::size_t parameter(std::size_t number) const { return followed_[number].index; }
  /// -1: at the lower end of the range, +1: at the upper end; 0: within.
  [[nodiscard]] int at_end(std::size_t number, const Eigen::VectorXd& baseline) const;
  [[nodiscard]] double learnt(std::size_t number) const { return followed_[number].learnt; }

  void serialize(estimator::StateArchive& archive);

 private:
  struct Followed {
    std::size_t index = 0;
    double learnt = 0.0;
    double below = 0.0;
    double above = 0.0;
    double told_s = 0.0;  ///< time of the latest window that determined it; NaN: none
  };
  double rate_per_s_;
  std::vector<Followed> followed_;
};

}  // namespace estimator::greybox::tracking
