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
// parameter, the others as they are, leaves no more within kChance (sensor_rival.h): its scale is
// to command and position nearly what the valve gain is, and its drift what a null bias is.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

struct Thresholds {
  double least_ratio = 0.03;  ///< ratio to the healthy value; linear parameters: kLeastOfTypical
  double sure = 5.0;          ///< standard errors
  double at_once = 20.0;      ///< standard errors at which one window is enough for an alarm
  bool suspect_position_sensor = false;  ///< it may have changed, too, and joins the groups
};

/// Least change of an effect's parameter, as a ratio to its typical size.
inline constexpr double kLeastOfTypical = 0.2;
inline constexpr double kChance = 16.0;  ///< chi-square
inline constexpr double kLeft = 1e-3;
inline constexpr double kAsGood = 1.05;  ///< ratio of the RMS errors
/// Prior width, as a ratio to the value, up to which a plant parameter may be a rival: less certain
/// ones
/// are calibrated by healthy records.
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
  std::vector<Rival> rivals;  ///< empty: the name is unique
  SensedPressures sensed;     ///< readings used beside command and position
};

/// Names of the previous window: the same parameters changed in the same directions keep their
/// rivals,
/// whose search takes most of the time; the rivals are searched again every kAnew windows.
struct NamingCache {
  static constexpr int kAnew = 10;
  std::vector<signed char> directions;  ///< per tracked parameter; empty: nothing cached
  int left = 0;                         ///< windows for which it may be kept
  std::vector<ParameterChange> named;

  void serialize(estimator::StateArchive& archive, const ParameterSet& set);
};

inline constexpr std::size_t kNotMeasured = static_cast<std::size_t>(-1);

/// Tracked parameters that were not fitted.
struct HeldParameters {
  std::size_t measured = kNotMeasured;  ///< was read, and so has no rivals
  std::size_t baseline = kNotMeasured;  ///< held at its healthy value; a rival of other parameters
};

/// `baseline`: theta of every parameter; `found`: the fit of the tracked ones to `data`.
[[nodiscard]] std::vector<ParameterChange> name_changes(
    WindowFit& fit, const ParameterSet& set, const WindowData& data, const WindowFitSummary& found,
    const Eigen::VectorXd& baseline, const ErrorScales& errors, const Thresholds& thresholds,
    NamingCache& cache, const HeldParameters& held = {});

/// Bit for bit (state_archive.h).
void serialize(estimator::StateArchive& archive, std::vector<ParameterChange>& named,
               const ParameterSet& set);

}  // namespace estimator::greybox::tracking
