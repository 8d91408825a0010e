// Physical parameters tracked over a sliding window, sample by sample.
//
// Each stride, the tracked parameters are fitted to the latest window (window_fit.h), the window is
// judged (invalid with a reason when the model does not explain it or the motion does not determine
// the parameters), and changes are named (change_naming.h). The model cannot explain a window in
// which the rig changed; its latest part is then fitted alone, which names a change before the
// window is over. One call of push() runs at most one such fit; all other calls only store the
// sample.
//
// Pressures, where they come with every sample of a window:
// - The mean supply pressure replaces the fit of that parameter.
// - The chamber pressures are fitted beside the position once the baseline has their errors.
// Before,
//   each window is fitted by its position alone, then with the errors it showed; where both supply
//   pressure and valve gain are tracked, the gain is the file's.
//   Where the pressures misfit while the position fits (a failed transducer, or a change that is
// not
//   tracked), or a transducer's reading stands still, the window is fitted by position alone
//   (WindowResult::left_out). By position alone valve gain and supply pressure are not separable:
//   where both are tracked the gain is held, and a change is named as the group of the two.
//
// On a disturbed rig (Baseline::noise) the position alone is used. The window grows up to
// disturbed_window_s; it begins anew where a parameter changed within it, and changes are judged by
// the few parameters that explain the window's latest part (tail_information.h).
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
#include "estimator/greybox/tracking/process_noise.h"
#include "estimator/greybox/tracking/sample_buffer.h"
#include "estimator/greybox/tracking/tail_information.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/greybox/tracking/window_fusion.h"
#include "estimator/greybox/tracking/window_result.h"

namespace estimator::greybox::tracking {

struct TrackerSettings {
  double window_s = 2.0;
  double stride_s = 0.5;
  double observer_per_s = kObserver_per_s;
  double most_ratio = 1.2;       ///< ratio to the healthy error above which a window is invalid
  double most_std_error = 0.01;  ///< ratio above which a value is invalid
  double most_of_typical = 0.1;  ///< the same for an effect, relative to its typical size
  std::int64_t fused = 4;        ///< limit of agreeing windows that are fused (window_fusion.h)
  // used on a disturbed rig alone
  double disturbed_window_s = 30.0;   ///< longest window
  double disturbed_std_error = 0.25;  ///< ratio above which a value is invalid
  Thresholds thresholds;
  DriftSettings drift;
  ExcitationLimits probe;
};

class ParameterTracker {
 public:
  ParameterTracker(const plant_sim::ModelFile& model, const ParameterSet& set,
                   const TrackerSettings& settings, double sample_time_s, double noise_floor_m);

  /// From now on windows are judged and changes named; before, windows are only fitted.
  void take(const Baseline& baseline);
  /// Returns the window that ends with this sample, if one does. `first`: samples before it are
  /// missing.
  std::optional<WindowResult> push(double t_s, double u_V, double y_m, bool first,
                                   const config::signals::Pressures& pressures = {});

  [[nodiscard]] const ChangeDetector& detector() const { return detector_; }
  /// ChangeDetector::forget_cleared().
  void forget_cleared() { detector_.forget_cleared(); }
  /// Reference of changes: as learned, corrected for slow drift (baseline_drift.h).
  [[nodiscard]] const std::optional<Baseline>& baseline() const { return baseline_; }
  [[nodiscard]] const BaselineDrift& baseline_drift() const { return drift_; }
  [[nodiscard]] const ParameterSet& set() const { return set_; }
  /// Disturbance as measured last; null: the rig is not disturbed.
  [[nodiscard]] const DisturbanceLevel* level() const {
    return disturbed_ ? &disturbed_->level : nullptr;
  }

  /// Motion within the limits of the settings that determines the parameters best; takes about 0.1
  /// s. None without a baseline.
  [[nodiscard]] std::optional<ExcitationDesign> probe();

  /// Back to the initial state, without baseline.
  void reset();
  /// Bit-exact (state_archive.h), after forget_cleared().
  void serialize(estimator::StateArchive& archive);

 private:
  /// Fits the tracked parameters from `near`, except held ones.
  [[nodiscard]] WindowFitSummary fit(const WindowData& data, Eigen::VectorXd near,
                                     const ErrorScales& errors);
  /// Fit before the baseline is known.
  [[nodiscard]] WindowFitSummary first_fit(const WindowData& data);
  [[nodiscard]] HeldParameters held(const WindowData& data, const ErrorScales& errors) const;
  [[nodiscard]] WindowData usable(std::size_t samples, PressuresLeftOut& left_out) const;
  [[nodiscard]] Misfit misfit(const WindowFitSummary& found, double most_ratio) const;
  WindowResult look(double t_s);
  void estimate(WindowResult& window, const WindowFitSummary& found);
  void judge(WindowResult& window, const WindowData& data, const WindowFitSummary& found,
             const Misfit& misfit) const;
  [[nodiscard]] bool moves(const WindowData& data) const;
  [[nodiscard]] double noise_m() const;
  /// True when a part was explained; by position alone where the window has no pressures.
  bool look_at_part(WindowResult& window, const WindowData& whole);
  void name_changes_in(WindowResult& window, const WindowData& data, const WindowFitSummary& found);
  void refine(WindowResult& window) const;

  // used on a disturbed rig alone
  struct DisturbedState {
    std::size_t lead = 0;
    std::size_t longest = 0;
    SampleBuffer samples;
    WindowNoise noise;
    std::size_t since = 0;        ///< samples since the last gap or change, lead-in included
    std::size_t since_level = 0;  ///< samples since the level was measured
    double random = 0.0;          ///< present RMS of the random part
    DisturbanceLevel level{};     ///< as measured last
  };
  void prepare_disturbed();
  std::optional<WindowResult> push_disturbed(double t_s, double u_V, double y_m, bool first);
  std::optional<WindowResult> look_disturbed(double t_s);
  [[nodiscard]] disturbance::NoiseModel present_noise() const;
  [[nodiscard]] WindowData disturbed_data(std::size_t samples, const Eigen::VectorXd& theta);
  /// Deviation of a tail of the window `found` from the baseline.
  [[nodiscard]] DeviationCauses deviations_of(const TailInformation& tail,
                                              const WindowFitSummary& found) const;
  /// Parameters with an active alarm.
  [[nodiscard]] std::vector<std::size_t> standing() const;
  void name_deviations_in(WindowResult& window, const std::vector<TailInformation>& tails,
                          const WindowFitSummary& found);
  void follow_level(const WindowData& data, const Eigen::VectorXd& theta);
  void serialize_disturbed(estimator::StateArchive& archive);

  plant_sim::ModelFile model_;
  const ParameterSet set_;
  TrackerSettings settings_;
  double sample_time_s_;
  double noise_floor_m_;
  std::size_t lead_;
  std::size_t window_;
  std::size_t supply_;  ///< index of the tracked supply pressure, or kNotMeasured
  std::size_t gain_;    ///< index of the tracked valve gain, or kNotMeasured
  std::size_t stride_;
  WindowFit fit_;
  SampleBuffer samples_;
  std::size_t until_ = 0;       ///< samples until the next window
  bool pressures_out_ = false;  ///< chamber pressures misfit in the latest windows
  std::optional<Baseline> baseline_;
  BaselineDrift drift_;
  Eigen::VectorXd near_;  ///< start of the next fit
  WindowFusion fusion_;
  NamingCache cache_;
  ChangeDetector detector_;
  std::optional<DisturbedState> disturbed_;
};

}  // namespace estimator::greybox::tracking
