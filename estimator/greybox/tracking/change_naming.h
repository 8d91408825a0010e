// Which parameter has changed in a window, and which others would explain the window as well.
//
// A tracked parameter has changed when it is off its healthy value by `least` and by `sure`
// standard errors. The name is then held against rivals, parameters that are not tracked:
//   - one rival alone that leaves no more than all tracked ones together (within kChance): the
//     changes of several tracked parameters have that one cause. It forms a group with the tracked
//     parameter that explains most by itself, and no other parameter is named.
//   - a rival that takes the place of one named parameter, the others as they are, and takes away
//     its whole effect but for a share kLeft or kChance; and that leaves no more than the tracked
//     ones (within kAsGood) once others may follow: the tracked ones freely, those of the plant
//     that are hardly seen as far as the file may be off. It joins that parameter's group.
// Where the position sensor is suspected as well, it joins where its scale or drift in place of the
// parameter, the others as they are, leaves no more within kChance (sensor_hypothesis.h): its scale is
// to command and position nearly what the valve gain is, and its drift what a null bias is.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

struct Thresholds {
  double least_ratio = 0.03;  ///< of the healthy value; linear parameters: see kLeastOfTypical
  double sure = 5.0;          ///< standard errors
  double at_once = 20.0;      ///< standard errors at which one window is enough for an alarm
  bool suspect_position_sensor = false;  ///< it may have changed, too, and joins the groups
};

/// Of an effect's typical size: the least change of an effect's parameter.
inline constexpr double kLeastOfTypical = 0.2;
inline constexpr double kChance = 16.0;  ///< chi-square
inline constexpr double kLeft = 1e-3;
inline constexpr double kAsGood = 1.05;  ///< of the error's RMS
/// Of a plant's value: less sure ones are calibrated by healthy records, and do not follow.
inline constexpr double kMostUncertain_ratio = 0.1;

/// Least change of a parameter, search units: of an effect that the model has, no more than it is.
[[nodiscard]] double least_change(const ParameterSet& set, std::size_t parameter,
                                  const Thresholds& thresholds);

struct Rival {
  std::string name;
  double value = 0.0;  ///< that would explain the window
};

/// Pressures that a window was looked at with.
struct SensedPressures {
  bool supply = false;
  bool chambers = false;
};

struct ParameterChange {
  std::size_t parameter = 0;  ///< index of the choice
  double theta = 0.0;         ///< search value
  double std_error = 0.0;     ///< search units
  double deviation = 0.0;     ///< from healthy, search units
  std::vector<Rival> rivals;  ///< empty: the name stands alone
  SensedPressures sensed;     ///< what was looked at beside command and position
};

/// The names of the window before: the same parameters, off in the same directions, keep their
/// rivals, which cost most of the time to find; they are looked for anew every kAnew windows.
struct NamingCache {
  static constexpr int kAnew = 10;
  std::vector<signed char> directions;  ///< of each tracked parameter; empty: nothing to keep
  int left = 0;                         ///< windows for which it may be kept
  std::vector<ParameterChange> named;

  void serialize(estimator::StateArchive& archive, const ParameterSet& set);
};

inline constexpr std::size_t kNotMeasured = static_cast<std::size_t>(-1);

/// Tracked parameters that were not fitted.
struct HeldParameters {
  std::size_t measured = kNotMeasured;  ///< was read, and so has no rivals
  std::size_t baseline = kNotMeasured;  ///< stands at its healthy value, and is a rival of others
};

/// `healthy`: search values of every parameter; `found`: the fit of the tracked ones to `cut`.
[[nodiscard]] std::vector<ParameterChange> name_changes(
    WindowFit& fit, const ParameterSet& set, const WindowData& data, const WindowFitSummary& found,
    const Eigen::VectorXd& baseline, const ErrorScales& errors, const Thresholds& thresholds,
    NamingCache& cache, const HeldParameters& held = {});

/// Bit for bit (state_archive.h).
void serialize(estimator::StateArchive& archive, std::vector<ParameterChange>& named,
               const ParameterSet& set);

}  // namespace estimator::greybox::tracking
