// Alarms with a beginning and an end from changes named window by window.
//
// A change is detected at once when it is `at_once` standard errors off, or when two windows in a
// row name it in the same direction. It ends with a window in which the parameter is within its
// least change, by two standard errors.
#pragma once

#include <limits>
#include <vector>

#include "estimator/greybox/tracking/change_naming.h"

namespace estimator::greybox::tracking {

struct DetectedChange {
  ParameterChange named;  ///< from the latest whole window that named it, else from its first part
  double raised_s = 0.0;
  double cleared_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: active
  double confidence = 0.0;  ///< probability that the change exceeds the least change

  [[nodiscard]] bool active() const { return !(cleared_s == cleared_s); }
};

/// A tracked parameter's estimate in one window.
struct TrackedValue {
  double theta = 0.0;
  double std_error = 0.0;
};

class ChangeDetector {
 public:
  ChangeDetector() = default;
  ChangeDetector(const ParameterSet& set, const Thresholds& thresholds);

  /// `seen`: all tracked parameters; `whole`: a whole window, not a part.
  void update(double t_s, const std::vector<ParameterChange>& named,
              const std::vector<TrackedValue>& seen, const Eigen::VectorXd& baseline, bool whole);

  [[nodiscard]] const std::vector<DetectedChange>& changes() const { return changes_; }
  /// Active alarm that names the tracked parameter; null: none.
  [[nodiscard]] const DetectedChange* active(std::size_t parameter) const;
  /// Drops cleared alarms, for tracking without end.
  void forget_cleared();
  /// Bit-exact (state_archive.h), after forget_cleared().
  void serialize(estimator::StateArchive& archive, const ParameterSet& set);

 private:
  struct Track {
    double least = 0.0;
    int direction = 0;  ///< in the latest window that named it; 0: not named
    int active = -1;    ///< index of its alarm
    bool whole = false;
  };
  void raise(double t_s, Track& track, const ParameterChange& named, bool whole);

  Thresholds thresholds_;
  std::vector<Track> tracks_;
  std::vector<DetectedChange> changes_;
};

}  // namespace estimator::greybox::tracking
