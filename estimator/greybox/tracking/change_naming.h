// Naming of the parameter that has changed in a window, and of others that would explain the window
// as well.
//
// A tracked parameter has changed when it is off its healthy value by `least` and by `sure`
// standard errors. Rivals are parameters that are not tracked:
//   - a single rival that leaves no more than all tracked ones together (within kChance): the
// changes
//     of several tracked parameters have that one cause. It forms a group with the tracked
// parameter
//     that explains most by itself, and no other parameter is named.
//   - a rival that replaces one named parameter, the others fixed, and removes its whole effect
// except
//     a share kLeft or kChance; and that leaves no more than the tracked ones (within kAsGood) once
//     others may follow: the tracked ones freely, poorly visible plant parameters within the file's
//     uncertainty. It joins that parameter's group.
// Where the position sensor is suspected as well, it joins where its scale or drift in place of the
// parameter, the others fixed, leaves no more within kChance (sensor_hypothesis.h): for command and
// position its scale resembles the valve gain, and its drift a null bias.
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
  bool suspect_position_sensor =
      false;  ///< the position sensor may have changed too and joins the groups
  /// Share of a named change within which its parameter is back; 0: within the least change.
  double back_share = 0.0;
};

/// Least change of an effect's parameter, as a ratio to its typical size.
inline constexpr double kLeastOfTypical = 0.2;
inline constexpr double kChance = 16.0;  ///< chi-square
inline constexpr double kLeft = 1e-3;
inline constexpr double kAsGood = 1.05;  ///< ratio of the RMS errors
/// Largest number of rivals where rivals are judged alone: the best.
inline constexpr std::size_t kMostRivals = 3;
/// Prior width, as a ratio to the value, up to which a plant parameter may be a rival: less certain
/// ones are calibrated by healthy records.
inline constexpr double kMostUncertain_ratio = 0.1;

/// Least change of a parameter, search units; for an effect in the model at most its present size.
[[nodiscard]] double least_change(const ParameterSet& set, std::size_t parameter,
                                  const Thresholds& thresholds);

struct Rival {
  std::string name;
  double value = 0.0;  ///< value that would explain the window
};

/// Pressures used in the fit of a window.
struct SensedPressures {
  bool supply = false;
  bool chambers = false;
};

struct ParameterChange {
  std::size_t parameter = 0;  ///< index in the set
  double theta = 0.0;         ///< search value
  double std_error = 0.0;     ///< search units
  double deviation = 0.0;     ///< deviation from healthy, search units
  std::vector<Rival> rivals;  ///< empty: the name is unique
  SensedPressures sensed;     ///< readings used beside command and position
};

/// Names of the previous window: the same parameters changed in the same directions keep their
/// rivals, whose search takes most of the time; the rivals are searched again every kAnew windows.
struct NamingCache {
  static constexpr int kAnew = 10;
  std::vector<signed char> directions;  ///< per tracked parameter; empty: nothing cached
  int left = 0;                         ///< windows for which the cache stays valid
  std::vector<ParameterChange> named;

  void serialize(estimator::StateArchive& archive, const ParameterSet& set);
};

inline constexpr std::size_t kNotMeasured = static_cast<std::size_t>(-1);

/// Tracked parameters that were not fitted.
struct HeldParameters {
  std::size_t measured = kNotMeasured;  ///< replaced by a reading; has no rivals
  std::size_t baseline = kNotMeasured;  ///< held at its healthy value; a rival of other parameters
  /// True on a disturbed rig: the tracked parameters that were held at their healthy values, whose
  /// standard error in the fit is infinite, are rivals too, and rivals are judged alone.
  bool others_are_rivals = false;
  /// Parameters that changed before: not healthy even where this window is not sure of it.
  std::vector<std::size_t> standing{};
};

/// `baseline`: theta of every parameter; `found`: the fit of the tracked ones to `data`.
[[nodiscard]] std::vector<ParameterChange> name_changes(
    WindowFit& fit, const ParameterSet& set, const WindowData& data, const WindowFitSummary& found,
    const Eigen::VectorXd& baseline, const ErrorScales& errors, const Thresholds& thresholds,
    NamingCache& cache, const HeldParameters& held = {});

/// Bit-exact (state_archive.h).
void serialize(estimator::StateArchive& archive, std::vector<ParameterChange>& named,
               const ParameterSet& set);

}  // namespace estimator::greybox::tracking
