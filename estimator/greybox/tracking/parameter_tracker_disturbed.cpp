// Windows of a disturbed rig: innovations in place of a simulation's errors, and a window that
// grows up to settings.disturbed_window_s and begins again where a parameter changed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/tracking/parameter_tracker.h"
#include "estimator/greybox/tracking/tail_information.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Lead-in and shortest window: the gains know how unknown the start is.
constexpr double kDisturbedLead_s = 0.25;
constexpr double kShortest_s = 0.5;
/// Tails between which a change is looked for.
constexpr double kSpacing_s = 0.1;
/// Shortest tail whose deviation from the baseline is judged.
constexpr double kShortestJudged_s = 0.75;
/// Chi-square by which a shorter tail has to indicate a change better than a longer one.
constexpr double kShorter = 9.0;
/// Share of a named change within which the parameter counts as back.
constexpr double kBackShare = 0.5;
/// The level of the disturbance is measured so often, and followed by this share.
constexpr double kLevel_s = 8.0;
constexpr double kFollowed = 0.1;
/// The random part follows within this factor of the learned level.
constexpr double kMostFollowed = 3.0;
/// Excess of an error over the healthy one allowed by chance, in standard deviations.
constexpr double kChanceOfDisturbedRms = 3.5;
/// One-sided 95 % quantile, in standard errors.
constexpr double kOneSided95 = 1.645;

}  // namespace

void ParameterTracker::prepare_disturbed() {
  const std::size_t lead = samples_in(kDisturbedLead_s, sample_time_s_);
  const std::size_t longest =
      samples_in(std::max(settings_.disturbed_window_s, settings_.window_s), sample_time_s_);
  Thresholds thresholds = settings_.thresholds;
  thresholds.back_share = kBackShare;
  detector_ = ChangeDetector(set_, thresholds);
  disturbed_.emplace(DisturbedState{lead, longest, SampleBuffer(lead, longest),
                                    WindowNoise(model_, set_.parameters, sample_time_s_)});
  disturbed_->random = baseline_->noise->model.noise.disturbance_sd;
  disturbed_->level = baseline_->noise->healthy;
}

std::optional<WindowResult> ParameterTracker::push_disturbed(double t_s, double u_V, double y_m,
                                                             bool first) {
  DisturbedState& state = *disturbed_;
  if (first) {
    state.samples.clear();
    state.since = 0;
    until_ = 0;
  }
  state.samples.push(u_V, y_m, {});
  state.since = std::min(state.since + 1, state.lead + state.longest);
  ++state.since_level;
  if (until_ > 0) --until_;
  if (until_ > 0 || state.since < state.lead + samples_in(kShortest_s, sample_time_s_)) {
    return std::nullopt;
  }
  until_ = stride_;
  return look_disturbed(t_s);
}

disturbance::NoiseModel ParameterTracker::present_noise() const {
  disturbance::NoiseModel noise = baseline_->noise->model;
  noise.noise.disturbance_sd = disturbed_->random;
  return noise;
}

WindowData ParameterTracker::disturbed_data(std::size_t samples, const VectorXd& theta) {
  WindowData data = disturbed_->samples.latest(samples);
  data.gains = disturbed_->noise.gains(data, theta, present_noise(), baseline_->rms_m);
  return data;
}

std::optional<WindowResult> ParameterTracker::look_disturbed(double t_s) {
  const auto begin = std::chrono::steady_clock::now();
  DisturbedState& state = *disturbed_;
  const ErrorScales errors = baseline_->errors();
  const std::vector<std::size_t> tracked = set_.tracked_indices();
  const std::size_t spacing = samples_in(kSpacing_s, sample_time_s_);
  std::size_t samples = state.since - state.lead;
  WindowData data = disturbed_data(samples, near_);
  WindowFitSummary found = fit_.fit(data, tracked, near_, errors);
  std::vector<TailInformation> tails =
      tails_of(found.residual, found.jacobian, errors.rms_m, samples, spacing);
  if (const auto since = moves(data) ? samples_since_change(tails) : std::nullopt) {
    state.since = *since;
    near_ = baseline_->theta;
    if (state.since < state.lead + samples_in(kShortest_s, sample_time_s_)) {
      until_ = 1;
      return std::nullopt;
    }
    samples = state.since - state.lead;
    data = disturbed_data(samples, near_);
    found = fit_.fit(data, tracked, near_, errors);
    data = disturbed_data(samples, found.theta);
    found = fit_.fit(data, tracked, found.theta, errors);
    tails = tails_of(found.residual, found.jacobian, errors.rms_m, samples, spacing);
  }
  WindowResult window;
  window.t_s = t_s;
  window.from_s = t_s - static_cast<double>(samples - 1) * sample_time_s_;
  window.evaluations = found.evaluations;
  window.rms_m = found.rms_m;
  window.correlation = found.correlation;
  const double most =
      std::max(settings_.most_ratio,
               1.0 + kChanceOfDisturbedRms / std::sqrt(2.0 * static_cast<double>(samples)));
  const Misfit misfit = this->misfit(found, most);
  window.fits = !misfit;
  window.explained = moves(data) && window.fits;
  const DeviationCauses causes = deviations_of(tails.back(), found);
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    const FreeParameter& p = set_.parameters[i];
    ParameterEstimate one;
    one.theta = found.theta[at];
    one.value = p.to_physical(one.theta);
    one.std_error = found.std_error[at] * p.slope(one.theta);
    one.smallest = (std::max(least_change(set_, i, settings_.thresholds),
                             settings_.thresholds.sure * causes.std_error[at]) +
                    kOneSided95 * causes.std_error[at]) *
                   p.slope(one.theta);
    window.estimates.push_back(one);
  }
  judge(window, data, found, misfit);
  window.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!moves(data)) return window;
  if (window.fits) {
    near_ = found.theta;
    name_deviations_in(window, tails, found);
    follow_level(data, found.theta);
  }
  window.level = state.level;
  drift_.follow(window, window.fits, detector_, baseline_->theta);
  return window;
}

std::vector<std::size_t> ParameterTracker::standing() const {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    if (detector_.active(i) != nullptr) changed.push_back(i);
  }
  return changed;
}

DeviationCauses ParameterTracker::deviations_of(const TailInformation& tail,
                                                const WindowFitSummary& found) const {
  const auto count = static_cast<Index>(set_.tracked);
  VectorXd least(count);
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    least[static_cast<Index>(i)] = least_change(set_, i, settings_.thresholds);
  }
  const MatrixXd covariance =
      baseline_->noise->covariance +
      linear_algebra::solve_symmetric(tail.information, MatrixXd(MatrixXd::Identity(count, count)));
  const VectorXd deviation = (found.theta - baseline_->theta).head(count) + tail.step();
  return causes_of(deviation, covariance, least, settings_.thresholds.sure, standing());
}

void ParameterTracker::name_deviations_in(WindowResult& window,
                                          const std::vector<TailInformation>& tails,
                                          const WindowFitSummary& found) {
  const ErrorScales errors = baseline_->errors();
  const auto least = static_cast<double>(samples_in(kShortestJudged_s, sample_time_s_));
  DeviationCauses best = deviations_of(tails.back(), found);
  std::size_t samples = tails.back().samples;
  for (double length = 0.5 * static_cast<double>(samples); length >= least; length *= 0.5) {
    const auto tail = std::find_if(tails.begin(), tails.end(), [&](const TailInformation& one) {
      return static_cast<double>(one.samples) >= length;
    });
    DeviationCauses causes = deviations_of(*tail, found);
    if (!(causes.chi_square > best.chi_square + kShorter)) continue;
    best = std::move(causes);
    samples = tail->samples;
  }
  if (!best.parameters.empty()) {
    disturbed_->since = samples + disturbed_->lead;  // the window goes on from the change
    // The causes alone, the rest of the rig healthy.
    const WindowData data = disturbed_data(samples, near_);
    std::vector<std::size_t> open = best.parameters;
    std::sort(open.begin(), open.end());
    VectorXd start = baseline_->theta;
    for (const std::size_t i : open)
      start[static_cast<Index>(i)] = found.theta[static_cast<Index>(i)];
    WindowFitSummary alone = fit_.fit(data, open, start, errors);
    const VectorXd fitted_error = alone.std_error;
    alone.std_error = VectorXd::Constant(static_cast<Index>(set_.tracked),
                                         std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto at = static_cast<Index>(open[i]);
      alone.std_error[at] = std::max(fitted_error[static_cast<Index>(i)], best.std_error[at]);
      best.deviation[at] = alone.theta[at] - baseline_->theta[at];
      best.std_error[at] = alone.std_error[at];
    }
    HeldParameters held;
    held.others_are_rivals = true;
    held.standing = standing();
    window.named = name_changes(fit_, set_, data, alone, baseline_->theta, errors,
                                settings_.thresholds, cache_, held);
  }
  std::vector<TrackedValue> seen;
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    seen.push_back({baseline_->theta[at] + best.deviation[at], best.std_error[at]});
  }
  detector_.update(window.t_s, window.named, seen, baseline_->theta, true);
}

void ParameterTracker::follow_level(const WindowData& data, const VectorXd& theta) {
  DisturbedState& state = *disturbed_;
  const auto due = static_cast<double>(state.since_level) * sample_time_s_ >= kLevel_s;
  if (!due || static_cast<double>(data.samples) * sample_time_s_ < kLevel_s) return;
  state.since_level = 0;
  const WindowData latest = state.samples.latest(samples_in(kLevel_s, sample_time_s_));
  state.level = state.noise.level(latest, theta, present_noise(), baseline_->rms_m);
  const double learned = baseline_->noise->model.noise.disturbance_sd;
  state.random *= std::pow(state.level.random / state.random, kFollowed);
  state.random = std::clamp(state.random, learned / kMostFollowed, learned * kMostFollowed);
}

void ParameterTracker::serialize_disturbed(estimator::StateArchive& archive) {
  baseline_->noise->serialize(archive, set_.tracked);
  if (!archive.good()) return;
  if (archive.restores()) prepare_disturbed();
  DisturbedState& state = *disturbed_;
  state.samples.serialize(archive);
  archive.value(state.since);
  archive.value(state.since_level);
  archive.value(state.random);
  archive.value(state.level.random);
  archive.growing(state.level.line_values, kMostLines);
  if (state.since > state.lead + state.longest) archive.fail();
}

}  // namespace estimator::greybox::tracking
