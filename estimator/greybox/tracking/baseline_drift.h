// Changes that are too slow to be faults, as damping falls while oil and seals get warm: the
// healthy value of a parameter follows what the windows find, no faster than a stated rate and no
// further than a stated distance from what was learnt.
//
//   h += min(max(g (x - h), -r T), r T),   h0 - below <= h <= h0 + above
//
// h  healthy value that changes are counted from, search units     h0  as it was learnt
// x  what an explained window that names no change of it found     g   kGain, against chance
// T  time since the latest look at which the motion told x         r   rate
// below above  the stated distance m: of a ratio -ln(1 - m) and ln(1 + m), else m
//
// A change that is faster than r is named before it is followed, and from then on it is not. What
// comes by and by further is told by an alarm of its own.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/tracking/change_detector.h"
#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_result.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

/// Ratios are of the healthy value; of an effect's parameter: of its typical size.
struct DriftSettings {
  std::vector<std::string> parameters;  ///< of the tracked ones
  double ratio_per_h = 0.5;
  double most_ratio = 0.3;
};

class BaselineDrift {
 public:
  static constexpr double kGain = 0.2;

  /// Throws config::schema::ConfigError that begins with `where` for one that is not tracked.
  BaselineDrift(const ParameterSet& set, const DriftSettings& following,
                const std::string& where = "follow");

  /// Search values of the healthy rig, of every parameter.
  void take(const Eigen::VectorXd& learnt);
  /// A look at a window that is judged and named. `explained`: by the model, moving or not.
  void follow(const WindowResult& window, bool explained, const ChangeDetector& detector,
              Eigen::VectorXd& baseline);

  [[nodiscard]] std::size_t size() const noexcept { return followed_.size(); }
  /// Which tracked parameter the number-th is.
  [[nodiscard]] std::size_t parameter(std::size_t number) const { return followed_[number].index; }
  /// At the end of the distance that is followed: -1 below, +1 above; 0: within.
  [[nodiscard]] int at_end(std::size_t number, const Eigen::VectorXd& baseline) const;
  [[nodiscard]] double learnt(std::size_t number) const { return followed_[number].learnt; }

  void serialize(estimator::StateArchive& archive);

 private:
  struct Followed {
    std::size_t index = 0;
    double learnt = 0.0;
    double below = 0.0;
    double above = 0.0;
    double told_s = 0.0;  ///< time of the latest look that told it; NaN: none yet
  };
  double rate_per_s_;
  std::vector<Followed> followed_;
};

}  // namespace estimator::greybox::tracking
