#include "estimator/greybox/tracking/parameter_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/kinematics.h"
#include "plant_sim/hydraulics.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Parts of an unexplained window that are fitted alone, longest first.
constexpr double kParts[] = {0.75, 0.5, 0.25};
/// Excess of a part's error over the healthy one allowed by chance, in standard deviations.
constexpr double kChanceOfRms = 3.5;
/// Travel, in noise floors, below which a window counts as no motion.
constexpr double kLeastMotion = 10.0;
/// Least noise floor, as a ratio to the healthy error.
constexpr double kLeastOfHealthy = 0.2;
/// One-sided 95 % quantile, in standard errors.
constexpr double kMostly = 1.645;
std::size_t tracked_index(const ParameterSet& set, std::string_view name) {
  for (std::size_t i = 0; i < set.tracked; ++i) {
    if (set.parameters[i].name == name) return i;
  }
  return kNotMeasured;
}

std::string gain_parameter(const plant_sim::ModelFile& model) {
  const auto oil = plant_sim::hydraulics_of(model);
  return oil ? oil->gain_parameter : std::string();
}

double motion_m(const WindowData& data) {
  const double* const y_m = data.y_m + data.lead;
  const auto [low, high] = std::minmax_element(y_m, y_m + data.samples);
  return *high - *low;
}

}  // namespace

ParameterTracker::ParameterTracker(const plant_sim::ModelFile& model, const ParameterSet& set,
                                   const TrackerSettings& settings, double sample_time_s,
                                   double noise_floor_m)
    : model_(model),
      set_(set),
      settings_(settings),
      sample_time_s_(sample_time_s),
      noise_floor_m_(std::max(noise_floor_m, kLeastFloor_m)),
      lead_(samples_in(kLead_s, sample_time_s)),
      window_(samples_in(settings.window_s, sample_time_s)),
      supply_(tracked_index(set, "supply_pressure_Pa")),
      gain_(tracked_index(set, gain_parameter(model))),
      stride_(std::max<std::size_t>(1, samples_in(settings.stride_s, sample_time_s))),
      fit_(model, set.parameters, sample_time_s,
           lead_ + std::max(window_, samples_in(settings.disturbed_window_s, sample_time_s)),
           settings.observer_per_s),
      samples_(lead_, window_),
      drift_(set, settings.drift),
      near_(set.file),
      fusion_(set.tracked, (window_ + stride_ - 1) / stride_,
              static_cast<std::size_t>(std::max<std::int64_t>(1, settings.fused))),
      detector_(set, settings.thresholds) {}

void ParameterTracker::take(const Baseline& baseline) {
  baseline_ = baseline;
  drift_.take(baseline.theta);
  near_ = baseline.theta;
  if (baseline_->noise) prepare_disturbed();
}

std::optional<WindowResult> ParameterTracker::push(double t_s, double u_V, double y_m, bool first,
                                                   const config::signals::Pressures& pressures) {
  if (disturbed_) return push_disturbed(t_s, u_V, y_m, first);
  if (first) {
    samples_.clear();
    until_ = samples_.needed();
    fusion_.clear();
  }
  samples_.push(u_V, y_m, pressures);
  if (until_ > 0) --until_;
  if (until_ > 0 || !samples_.enough()) return std::nullopt;
  until_ = stride_;
  return look(t_s);
}

WindowResult ParameterTracker::look(double t_s) {
  WindowResult window;
  window.t_s = t_s;
  window.from_s = t_s - static_cast<double>(window_ - 1) * sample_time_s_;
  WindowData data = usable(window_, window.left_out);
  const auto begin = std::chrono::steady_clock::now();
  WindowFitSummary found = baseline_ ? fit(data, near_, baseline_->errors()) : first_fit(data);
  window.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  window.evaluations = found.evaluations;
  Misfit misfit = this->misfit(found, settings_.most_ratio);
  if (!misfit) pressures_out_ = false;
  bool part = false;
  if (misfit && moves(data) && found.with_chambers()) {
    part = look_at_part(window, data);
    if (!part) {
      const WindowData with = std::exchange(data, data.without_pressures());
      const ErrorScales errors = baseline_->errors();
      WindowFitSummary instead = fit(data, near_, errors);
      if (!this->misfit(instead, settings_.most_ratio)) {
        // A fit without the pressures shows which of the two chambers misfits.
        const Misfit shown =
            this->misfit(fit_.fit(with, {}, instead.theta, errors), settings_.most_ratio);
        if (shown) misfit = shown;
        window.left_out = {PressuresLeftOut::Cause::misfit, misfit};
        pressures_out_ = true;
        misfit = {};
        found = std::move(instead);
      }
    }
  }
  window.rms_m = found.rms_m;
  window.in = found.in;
  window.out = found.out;
  window.correlation = found.correlation;
  window.fits = !misfit;
  window.explained = moves(data) && window.fits;
  estimate(window, found);
  judge(window, data, found, misfit);
  if (window.explained) near_ = found.theta;
  if (!baseline_ || !moves(data)) return window;
  if (window.fits) {
    name_changes_in(window, data, found);
  } else if (!part && (pressures_out_ || !found.with_chambers())) {
    look_at_part(window, data);
  }
  drift_.follow(window, window.fits, detector_, baseline_->theta);
  return window;
}

bool ParameterTracker::moves(const WindowData& data) const {
  return motion_m(data) > kLeastMotion * noise_m();
}

double ParameterTracker::noise_m() const {
  return std::max(noise_floor_m_, baseline_ ? kLeastOfHealthy * baseline_->rms_m : 0.0);
}

void ParameterTracker::estimate(WindowResult& window, const WindowFitSummary& found) {
  const Eigen::VectorXd own = found.theta.head(static_cast<Index>(set_.tracked));
  const bool bounded =
      std::any_of(found.at_bound.begin(), found.at_bound.end(), [](int side) { return side != 0; });
  fusion_.add(own, found.covariance, window.explained && !bounded && found.std_error.allFinite());
  const FusedEstimate fused = fusion_.fused();
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    const FreeParameter& p = set_.parameters[i];
    const bool many = fused.windows > 1;
    ParameterEstimate one;
    one.theta = many ? fused.theta[at] : own[at];
    const double error = many ? std::sqrt(fused.covariance(at, at)) : found.std_error[at];
    one.value = p.to_physical(one.theta);
    one.std_error = error * p.slope(one.theta);
    const double named = std::max(least_change(set_, i, settings_.thresholds),
                                  settings_.thresholds.sure * found.std_error[at]);
    one.smallest = (named + kMostly * found.std_error[at]) * p.slope(one.theta);
    window.estimates.push_back(one);
  }
}

void ParameterTracker::judge(WindowResult& window, const WindowData& data,
                             const WindowFitSummary& found, const Misfit& misfit) const {
  InvalidReason all;
  if (!moves(data)) {
    all.cause = InvalidReason::Cause::no_motion;
    all.motion_m = motion_m(data);
    all.noise_m = noise_m();
    all.window_s = settings_.window_s;
  } else if (!window.explained) {
    all.cause = InvalidReason::Cause::misfit;
    all.misfit = misfit;
  }
  bool unseen = false;
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    ParameterEstimate& one = window.estimates[i];
    const FreeParameter& p = set_.parameters[i];
    const double most = p.scale != ParameterScale::logarithmic ? settings_.most_of_typical
                        : disturbed_                           ? settings_.disturbed_std_error
                                                               : settings_.most_std_error;
    one.invalid = all;
    if (!all && i == gain_ && window.left_out &&
        std::isinf(found.std_error[static_cast<Index>(i)])) {
      one.invalid.cause = InvalidReason::Cause::needs_pressures;
      one.invalid.left_out = window.left_out;
    } else if (!all) {
      one.invalid = imprecision_of(found, i, one.std_error / p.slope(one.theta), most);
      unseen = unseen || one.invalid;
    }
    one.valid = !one.invalid;
    if (!window.invalid) window.invalid = one.invalid;
  }
  window.valid = !window.invalid;
  window.poor = !moves(data) || (window.explained && unseen);
}

bool ParameterTracker::look_at_part(WindowResult& window, const WindowData& whole) {
  Eigen::VectorXd near = baseline_->theta;
  for (const double share : kParts) {
    const auto samples = static_cast<std::size_t>(share * static_cast<double>(window_));
    PressuresLeftOut left_out;
    WindowData data = usable(samples, left_out);
    if (whole.in_Pa == nullptr) data = data.without_pressures();
    const WindowFitSummary part = fit(data, near, baseline_->errors());
    const double most = std::max(
        settings_.most_ratio, 1.0 + kChanceOfRms / std::sqrt(2.0 * static_cast<double>(samples)));
    if (misfit(part, most)) continue;
    if (!moves(data)) return true;
    window.part =
        PartialFit{static_cast<double>(samples) * sample_time_s_, part.theta, part.std_error};
    name_changes_in(window, data, part);
    near_ = part.theta;
    return true;
  }
  return false;
}

void ParameterTracker::name_changes_in(WindowResult& window, const WindowData& data,
                                       const WindowFitSummary& found) {
  const bool whole = data.samples == window_;
  NamingCache once;  // the rivals of a part differ from those of the whole window
  const ErrorScales errors = baseline_->errors();
  window.named = name_changes(fit_, set_, data, found, baseline_->theta, errors,
                              settings_.thresholds, whole ? cache_ : once, held(data, errors));
  if (whole) refine(window);
  std::vector<TrackedValue> seen;
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    seen.push_back({found.theta[static_cast<Index>(i)], found.std_error[static_cast<Index>(i)]});
  }
  detector_.update(window.t_s, window.named, seen, baseline_->theta, whole);
}

/// Replaces the values of named changes by those fused from agreeing windows.
void ParameterTracker::refine(WindowResult& window) const {
  for (ParameterChange& one : window.named) {
    const ParameterEstimate& best = window.estimates[one.parameter];
    one.theta = best.theta;
    one.std_error = best.std_error / set_.parameters[one.parameter].slope(best.theta);
    one.deviation = best.theta - baseline_->theta[static_cast<Index>(one.parameter)];
  }
}

void ParameterTracker::reset() {
  samples_.clear();
  until_ = 0;
  baseline_.reset();
  near_ = set_.file;
  fusion_.clear();
  cache_ = {};
  pressures_out_ = false;
  detector_ = ChangeDetector(set_, settings_.thresholds);
  disturbed_.reset();
}

void ParameterTracker::serialize(estimator::StateArchive& archive) {
  const auto vector = [&archive](Eigen::VectorXd& theta) {
    for (double& value : theta) archive.value(value);
  };
  samples_.serialize(archive);
  archive.value(until_);
  archive.value(pressures_out_);
  enum class Known : unsigned char { nothing, baseline, disturbed_baseline };
  Known known = !baseline_         ? Known::nothing
                : baseline_->noise ? Known::disturbed_baseline
                                   : Known::baseline;
  archive.value(known);
  if (archive.restores()) {
    baseline_.reset();
    disturbed_.reset();
    if (known != Known::nothing) baseline_ = Baseline{0.0, set_.file, {}};
    if (known == Known::disturbed_baseline) baseline_->noise.emplace();
  }
  if (baseline_) {
    archive.value(baseline_->rms_m);
    vector(baseline_->theta);
    baseline_->chambers.serialize(archive);
    if (baseline_->noise) serialize_disturbed(archive);
  }
  drift_.serialize(archive);
  vector(near_);
  fusion_.serialize(archive);
  cache_.serialize(archive, set_);
  detector_.serialize(archive, set_);
}

}  // namespace estimator::greybox::tracking
