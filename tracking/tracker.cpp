#include "tracking/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "config/schema/error.h"
#include "tracking/least_floor.h"
#include "tracking/quantity.h"
#include "tracking/words.h"

namespace tracking {
namespace {

using Eigen::Index;

/// Parts of a window that are looked at when it is not explained, the longest first.
constexpr double kParts[] = {0.75, 0.5, 0.25};
/// How far a part's error may be above the healthy one: in chance's standard deviations.
constexpr double kChanceOfRms = 3.5;
/// A rod that moves less than this many noise floors tells nothing.
constexpr double kLeastMotion = 10.0;

std::size_t samples_in(double duration_s, double sample_time_s) {
  return static_cast<std::size_t>(std::lround(duration_s / sample_time_s));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double motion_m(const Cut& cut) {
  const double* const y_m = cut.y_m + cut.lead;
  const auto [low, high] = std::minmax_element(y_m, y_m + cut.samples);
  return *high - *low;
}

}  // namespace

Tracker::Tracker(const plant_sim::ModelFile& model, const Choice& choice, const Settings& settings,
                 double sample_time_s, double noise_floor_m)
    : choice_(choice),
      settings_(settings),
      sample_time_s_(sample_time_s),
      noise_floor_m_(std::max(noise_floor_m, kLeastFloor_m)),
      lead_(samples_in(kLead_s, sample_time_s)),
      window_(samples_in(settings.window_s, sample_time_s)),
      stride_(std::max<std::size_t>(1, samples_in(settings.stride_s, sample_time_s))),
      fit_(model, choice.parameters, sample_time_s, lead_ + window_, settings.observer_per_s),
      u_V_(2 * (lead_ + window_)),
      y_m_(u_V_.size()),
      near_(choice.file),
      alarms_(choice, settings.thresholds) {}

void Tracker::take(const Healthy& healthy) {
  healthy_ = healthy;
  near_ = healthy.x;
}

std::optional<Window> Tracker::push(double t_s, double u_V, double y_m, bool first) {
  const std::size_t needed = lead_ + window_;
  if (first) {
    kept_ = 0;
    until_ = needed;
  }
  if (kept_ == u_V_.size()) {
    const auto half = static_cast<std::ptrdiff_t>(needed);
    std::copy(u_V_.end() - half, u_V_.end(), u_V_.begin());
    std::copy(y_m_.end() - half, y_m_.end(), y_m_.begin());
    kept_ = needed;
  }
  u_V_[kept_] = u_V;
  y_m_[kept_] = y_m;
  ++kept_;
  if (until_ > 0) --until_;
  if (until_ > 0 || kept_ < needed) return std::nullopt;
  until_ = stride_;
  return look(t_s);
}

Cut Tracker::latest(std::size_t samples) const {
  const std::size_t from = kept_ - samples - lead_;
  return {u_V_.data() + from, y_m_.data() + from, lead_, samples};
}

Window Tracker::look(double t_s) {
  Window window;
  window.t_s = t_s;
  window.from_s = t_s - static_cast<double>(window_ - 1) * sample_time_s_;
  const Cut cut = latest(window_);
  const double sigma_m = healthy_ ? healthy_->rms_m : noise_floor_m_;
  const auto begin = std::chrono::steady_clock::now();
  const WindowEstimate found = fit_.fit(cut, choice_.tracked_indices(), near_, sigma_m);
  window.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  window.evaluations = found.evaluations;
  window.rms_m = found.rms_m;
  window.correlation = found.correlation;
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    const SearchParameter& p = choice_.parameters[i];
    window.estimates.push_back(
        {found.x[at], p.value(found.x[at]), found.std_error[at] * p.slope(found.x[at])});
  }
  judge(window, cut, found);
  if (window.valid) near_ = found.x;
  if (!healthy_) return window;
  const bool moves = motion_m(cut) > kLeastMotion * noise_floor_m_;
  if (found.rms_m <= settings_.most_ratio * healthy_->rms_m) {
    if (moves) tell(window, cut, found);
  } else if (moves) {
    look_at_part(window);
  }
  return window;
}

void Tracker::judge(Window& window, const Cut& cut, const WindowEstimate& found) const {
  const double moved_m = motion_m(cut);
  if (!(moved_m > kLeastMotion * noise_floor_m_)) {
    window.why = still_words(moved_m, noise_floor_m_, settings_.window_s);
  } else if (healthy_ && found.rms_m > settings_.most_ratio * healthy_->rms_m) {
    window.why = unexplained_words(found.rms_m, healthy_->rms_m, settings_.most_ratio);
  } else {
    window.why = unseen_words(choice_, found, settings_.most_std_error);
  }
  window.valid = window.why.empty();
}

void Tracker::look_at_part(Window& window) {
  Eigen::VectorXd near = healthy_->x;
  for (const double share : kParts) {
    const auto samples = static_cast<std::size_t>(share * static_cast<double>(window_));
    const Cut cut = latest(samples);
    const WindowEstimate part = fit_.fit(cut, choice_.tracked_indices(), near, healthy_->rms_m);
    const double most = std::max(
        settings_.most_ratio, 1.0 + kChanceOfRms / std::sqrt(2.0 * static_cast<double>(samples)));
    if (part.rms_m > most * healthy_->rms_m) continue;
    if (!(motion_m(cut) > kLeastMotion * noise_floor_m_)) return;
    window.part = part_words(choice_, part, static_cast<double>(samples) * sample_time_s_);
    tell(window, cut, part);
    near_ = part.x;
    return;
  }
}

void Tracker::tell(Window& window, const Cut& cut, const WindowEstimate& found) {
  window.named =
      name_changes(fit_, choice_, cut, found, healthy_->x, healthy_->rms_m, settings_.thresholds);
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    seen.push_back({found.x[static_cast<Index>(i)], found.std_error[static_cast<Index>(i)]});
  }
  alarms_.update(window.t_s, window.named, seen, healthy_->x, cut.samples == window_);
}

Healthy learn(const std::vector<Window>& windows, const Choice& choice, double noise_floor_m,
              const std::string& where) {
  std::vector<double> rms_m;
  std::vector<std::vector<double>> x(choice.tracked);
  std::string why = "has no whole window";
  for (const Window& window : windows) {
    if (!window.valid) {
      why = "has no usable window: " + window.why;
      continue;
    }
    rms_m.push_back(window.rms_m);
    for (std::size_t i = 0; i < x.size(); ++i) x[i].push_back(window.estimates[i].x);
  }
  if (rms_m.empty()) {
    throw config::schema::bad_data(where, why, "a healthy motion that tells the parameters");
  }
  Healthy healthy;
  healthy.rms_m = std::max({median(rms_m), noise_floor_m, kLeastFloor_m});
  healthy.x = choice.file;
  for (std::size_t i = 0; i < x.size(); ++i) healthy.x[static_cast<Index>(i)] = median(x[i]);
  return healthy;
}

}  // namespace tracking
