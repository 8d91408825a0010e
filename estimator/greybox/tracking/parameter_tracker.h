// Physical parameters tracked over a sliding window, sample by sample.
//
// Each stride: the tracked parameters are fitted to the latest window (window_fit.h), the window is
// judged (a model that does not explain it, or a motion that cannot tell the parameters, makes it
// invalid, with the reason), and changes are named (naming.h). A window in which the rig changed
// explains nothing: then its latest part alone is looked at, which is how a change is named before
// the window is over. One call of push() does at most one such look; all others only keep the
// sample.
//
// Pressures, where they come with every sample of a window:
// - The supply's mean takes the place of that parameter's fit.
// - The chambers' count in the fit beside the position, once the healthy rig knows their errors.
//   Before, each window is fitted by its position alone, and then with the errors that it showed;
//   where both supply pressure and valve gain are tracked, the gain is the file's.
//   Where they do not belong to the model while the position does (a failed transducer, or a change
//   that is not tracked), or a transducer stands still, the window is looked at by position alone,
//   and says so (Window::left_out). By position alone valve gain and supply pressure are one
//   number: where both are tracked the gain is held then, and a change is told as the group of the
//   two.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "estimator/greybox/tracking/baseline.h"
#include "estimator/greybox/tracking/baseline_drift.h"
#include "estimator/greybox/tracking/change_detector.h"
#include "estimator/greybox/tracking/change_naming.h"
#include "estimator/greybox/tracking/excitation_design.h"
#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/sample_buffer.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/greybox/tracking/window_fusion.h"
#include "estimator/greybox/tracking/window_result.h"

namespace estimator::greybox::tracking {

struct TrackerSettings {
  double window_s = 2.0;
  double stride_s = 0.5;
  double observer_per_s = kObserver_per_s;
  double most_ratio = 1.2;       ///< of the healthy error, beyond which a window is invalid
  double most_std_error = 0.01;  ///< ratio, beyond which a value is invalid
  double most_of_typical = 0.1;  ///< the same of an effect, over its typical size
  std::int64_t fused = 4;        ///< windows that a value is taken from while they agree (pool.h)
  Thresholds thresholds;
  DriftSettings drift;
  ExcitationLimits probe;
};

class ParameterTracker {
 public:
  ParameterTracker(const plant_sim::ModelFile& model, const ParameterSet& set,
                   const TrackerSettings& settings, double sample_time_s, double noise_floor_m);

  /// From now on windows are judged and changes named; before, they are only fitted.
  void take(const Baseline& baseline);
  /// The window that ends with this sample, when one does. `first`: samples before it are missing.
  std::optional<WindowResult> push(double t_s, double u_V, double y_m, bool first,
                                   const config::signals::Pressures& pressures = {});

  [[nodiscard]] const ChangeDetector& detector() const { return detector_; }
  /// AlarmBook::forget_cleared().
  void forget_cleared() { detector_.forget_cleared(); }
  /// What changes are counted from: as learnt, but for what has changed slowly (slow_change.h).
  [[nodiscard]] const std::optional<Baseline>& baseline() const { return baseline_; }
  [[nodiscard]] const BaselineDrift& baseline_drift() const { return drift_; }
  [[nodiscard]] const ParameterSet& set() const { return set_; }

  /// What motion within the limits of the settings would tell; a tenth of a second or so. Once the
  /// healthy rig is known.
  [[nodiscard]] std::optional<ExcitationDesign> probe();

  /// As at the start, the healthy rig forgotten.
  void reset();
  /// Bit for bit (state_archive.h), after forget_cleared().
  void serialize(estimator::StateArchive& archive);

 private:
  /// Fits the tracked parameters from `near`, but those that are held.
  [[nodiscard]] WindowFitSummary fit(const WindowData& data, Eigen::VectorXd near,
                                     const ErrorScales& errors);
  /// Before the healthy rig is known.
  [[nodiscard]] WindowFitSummary first_fit(const WindowData& data);
  [[nodiscard]] HeldParameters held(const WindowData& data, const ErrorScales& errors) const;
  [[nodiscard]] WindowData usable(std::size_t samples, std::string& left_out) const;
  [[nodiscard]] std::string misfit(const WindowFitSummary& found, double most_ratio) const;
  WindowResult look(double t_s);
  void estimate(WindowResult& window, const WindowFitSummary& found);
  void judge(WindowResult& window, const WindowData& data, const WindowFitSummary& found,
             const std::string& misfit) const;
  [[nodiscard]] bool moves(const WindowData& data) const;
  [[nodiscard]] double noise_m() const;
  /// Whether a part was explained; by position alone where the cut has no pressures.
  bool look_at_part(WindowResult& window, const WindowData& whole);
  void name_changes_in(WindowResult& window, const WindowData& data, const WindowFitSummary& found);
  void refine(WindowResult& window) const;

  plant_sim::ModelFile model_;
  const ParameterSet set_;
  TrackerSettings settings_;
  double sample_time_s_;
  double noise_floor_m_;
  std::size_t lead_;
  std::size_t window_;
  std::size_t supply_;  ///< index of the supply pressure where it is tracked; else kNotMeasured
  std::size_t gain_;    ///< the same of the valve gain
  std::size_t stride_;
  WindowFit fit_;
  SampleBuffer samples_;
  std::size_t until_ = 0;       ///< samples until the next look
  bool pressures_out_ = false;  ///< chamber pressures have not belonged to the model lately
  std::optional<Baseline> baseline_;
  BaselineDrift drift_;
  Eigen::VectorXd near_;  ///< where the next search begins
  WindowFusion fusion_;
  NamingCache cache_;
  ChangeDetector detector_;
};

}  // namespace estimator::greybox::tracking
