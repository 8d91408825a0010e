#include "daemon/tracking/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "daemon/tracking/least_floor.h"
#include "daemon/tracking/quantity.h"
#include "daemon/tracking/reading.h"
#include "daemon/tracking/words.h"

namespace monitor::tracking {
namespace {

using Eigen::Index;

/// Parts of a window that are looked at when it is not explained, the longest first.
constexpr double kParts[] = {0.75, 0.5, 0.25};
/// How far a part's error may be above the healthy one: in chance's standard deviations.
constexpr double kChanceOfRms = 3.5;
/// A rod that moves less than this many noise floors tells nothing.
constexpr double kLeastMotion = 10.0;
/// Of the healthy error: what the noise floor is at least taken for.
constexpr double kLeastOfHealthy = 0.2;
/// Standard errors: one-sided, 95 %.
constexpr double kMostly = 1.645;

std::size_t samples_in(double duration_s, double sample_time_s) {
  return static_cast<std::size_t>(std::lround(duration_s / sample_time_s));
}

std::size_t tracked_index(const Choice& choice, std::string_view name) {
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    if (choice.parameters[i].name == name) return i;
  }
  return kNotMeasured;
}

double motion_m(const Cut& cut) {
  const double* const y_m = cut.y_m + cut.lead;
  const auto [low, high] = std::minmax_element(y_m, y_m + cut.samples);
  return *high - *low;
}

}  // namespace

Tracker::Tracker(const plant_sim::ModelFile& model, const Choice& choice, const Settings& settings,
                 double sample_time_s, double noise_floor_m)
    : model_(model),
      choice_(choice),
      settings_(settings),
      sample_time_s_(sample_time_s),
      noise_floor_m_(std::max(noise_floor_m, kLeastFloor_m)),
      lead_(samples_in(kLead_s, sample_time_s)),
      window_(samples_in(settings.window_s, sample_time_s)),
      supply_(tracked_index(choice, "supply_pressure_Pa")),
      stride_(std::max<std::size_t>(1, samples_in(settings.stride_s, sample_time_s))),
      fit_(model, choice.parameters, sample_time_s, lead_ + window_, settings.observer_per_s),
      samples_(lead_, window_),
      near_(choice.file),
      pool_(choice.tracked, (window_ + stride_ - 1) / stride_,
            static_cast<std::size_t>(std::max<std::int64_t>(1, settings.pooled))),
      alarms_(choice, settings.thresholds) {}

void Tracker::take(const Healthy& healthy) {
  healthy_ = healthy;
  near_ = healthy.x;
}

std::optional<Window> Tracker::push(double t_s, double u_V, double y_m, bool first,
                                    double supply_Pa) {
  if (first) {
    samples_.clear();
    until_ = samples_.needed();
    pool_.clear();
  }
  samples_.push(u_V, y_m, supply_Pa);
  if (until_ > 0) --until_;
  if (until_ > 0 || !samples_.enough()) return std::nullopt;
  until_ = stride_;
  return look(t_s);
}

std::size_t Tracker::measured(std::size_t samples) const {
  const bool read = supply_ != kNotMeasured && samples_.supply_Pa(samples) != nullptr;
  return read ? supply_ : kNotMeasured;
}

WindowEstimate Tracker::fit(const Cut& cut, Eigen::VectorXd near, double sigma_m) {
  std::vector<std::size_t> free = choice_.tracked_indices();
  const std::size_t held = measured(cut.samples);
  if (held == kNotMeasured) return fit_.fit(cut, free, near, sigma_m);
  const SearchParameter& p = choice_.parameters[held];
  const Reading read = reading_of(samples_.supply_Pa(cut.samples), cut.samples);
  double& at = near[static_cast<Index>(held)];
  at = p.search(read.mean);
  free.erase(free.begin() + static_cast<std::ptrdiff_t>(held));
  const double std_error = read.std_error / p.slope(at);
  return with_reading(fit_.fit(cut, free, near, sigma_m), held, std_error);
}

Window Tracker::look(double t_s) {
  Window window;
  window.t_s = t_s;
  window.from_s = t_s - static_cast<double>(window_ - 1) * sample_time_s_;
  const Cut cut = samples_.latest(window_);
  const double sigma_m = healthy_ ? healthy_->rms_m : noise_floor_m_;
  const auto begin = std::chrono::steady_clock::now();
  const WindowEstimate found = fit(cut, near_, sigma_m);
  window.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  window.evaluations = found.evaluations;
  window.rms_m = found.rms_m;
  window.correlation = found.correlation;
  const bool fits = !healthy_ || found.rms_m <= settings_.most_ratio * healthy_->rms_m;
  window.explained = moves(cut) && fits;
  estimate(window, found);
  judge(window, cut, found);
  if (window.explained) near_ = found.x;
  if (!healthy_ || !moves(cut)) return window;
  if (fits) {
    tell(window, cut, found);
  } else {
    look_at_part(window);
  }
  return window;
}

bool Tracker::moves(const Cut& cut) const { return motion_m(cut) > kLeastMotion * noise_m(); }

double Tracker::noise_m() const {
  return std::max(noise_floor_m_, healthy_ ? kLeastOfHealthy * healthy_->rms_m : 0.0);
}

void Tracker::estimate(Window& window, const WindowEstimate& found) {
  const Eigen::VectorXd own = found.x.head(static_cast<Index>(choice_.tracked));
  const bool bounded =
      std::any_of(found.at_bound.begin(), found.at_bound.end(), [](int side) { return side != 0; });
  pool_.add(own, found.covariance, window.explained && !bounded && found.std_error.allFinite());
  const Pooled pooled = pool_.pooled();
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    const SearchParameter& p = choice_.parameters[i];
    const bool many = pooled.windows > 1;
    Estimate one;
    one.x = many ? pooled.x[at] : own[at];
    const double error = many ? std::sqrt(pooled.covariance(at, at)) : found.std_error[at];
    one.value = p.value(one.x);
    one.std_error = error * p.slope(one.x);
    const double named = std::max(least_of(choice_, i, settings_.thresholds),
                                  settings_.thresholds.sure * found.std_error[at]);
    one.smallest = (named + kMostly * found.std_error[at]) * p.slope(one.x);
    window.estimates.push_back(one);
  }
}

void Tracker::judge(Window& window, const Cut& cut, const WindowEstimate& found) const {
  std::string why;
  if (!moves(cut)) {
    why = still_words(motion_m(cut), noise_m(), settings_.window_s);
  } else if (!window.explained) {
    why = unexplained_words(found.rms_m, healthy_->rms_m, settings_.most_ratio);
  }
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    Estimate& one = window.estimates[i];
    const SearchParameter& p = choice_.parameters[i];
    const double most =
        p.scale == Scale::logarithmic ? settings_.most_std_error : settings_.most_of_typical;
    one.why =
        why.empty() ? unseen_words(choice_, found, i, one.std_error / p.slope(one.x), most) : why;
    one.valid = one.why.empty();
    if (window.why.empty()) window.why = one.why;
  }
  window.valid = window.why.empty();
  window.poor = !moves(cut) || (window.explained && !window.valid);
}

std::optional<Probe> Tracker::probe() {
  if (!settings_.probe.given() || !healthy_) return std::nullopt;
  plant_sim::ModelFile healthy = model_;
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    const SearchParameter& p = choice_.parameters[i];
    if (double* value = healthy.value(p.name)) {
      *value = p.value(healthy_->x[static_cast<Index>(i)]);
    }
  }
  return best_probe(healthy, settings_.probe, lead_ + window_, sample_time_s_, healthy_->rms_m,
                    [this](const double* u_V, const double* y_m) {
                      return fit_
                          .fit({u_V, y_m, lead_, window_}, choice_.tracked_indices(), healthy_->x,
                               healthy_->rms_m)
                          .std_error;
                    });
}

void Tracker::look_at_part(Window& window) {
  Eigen::VectorXd near = healthy_->x;
  for (const double share : kParts) {
    const auto samples = static_cast<std::size_t>(share * static_cast<double>(window_));
    const Cut cut = samples_.latest(samples);
    const WindowEstimate part = fit(cut, near, healthy_->rms_m);
    const double most = std::max(
        settings_.most_ratio, 1.0 + kChanceOfRms / std::sqrt(2.0 * static_cast<double>(samples)));
    if (part.rms_m > most * healthy_->rms_m) continue;
    if (!moves(cut)) return;
    window.part = part_words(choice_, part, static_cast<double>(samples) * sample_time_s_);
    tell(window, cut, part);
    near_ = part.x;
    return;
  }
}

void Tracker::tell(Window& window, const Cut& cut, const WindowEstimate& found) {
  const bool whole = cut.samples == window_;
  Memory once;  // the rivals of a part are not those of the whole window
  window.named = name_changes(fit_, choice_, cut, found, healthy_->x, healthy_->rms_m,
                              settings_.thresholds, whole ? memory_ : once, measured(cut.samples));
  if (whole) refine(window);
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    seen.push_back({found.x[static_cast<Index>(i)], found.std_error[static_cast<Index>(i)]});
  }
  alarms_.update(window.t_s, window.named, seen, healthy_->x, whole);
}

/// What is named has the values of the windows that agree with this one.
void Tracker::refine(Window& window) const {
  for (Named& one : window.named) {
    const Estimate& best = window.estimates[one.parameter];
    one.x = best.x;
    one.std_error = best.std_error / choice_.parameters[one.parameter].slope(best.x);
    one.deviation = best.x - healthy_->x[static_cast<Index>(one.parameter)];
  }
}

void Tracker::reset() {
  samples_.clear();
  until_ = 0;
  healthy_.reset();
  near_ = choice_.file;
  pool_.clear();
  memory_ = {};
  alarms_ = AlarmBook(choice_, settings_.thresholds);
}

void Tracker::carry(estimator::Carrier& carrier) {
  const auto vector = [&carrier](Eigen::VectorXd& x) {
    for (double& value : x) carrier.value(value);
  };
  samples_.carry(carrier);
  carrier.value(until_);
  bool knows = healthy_.has_value();
  carrier.value(knows);
  if (carrier.restores()) {
    healthy_.reset();
    if (knows) healthy_ = Healthy{0.0, choice_.file};
  }
  if (healthy_) {
    carrier.value(healthy_->rms_m);
    vector(healthy_->x);
  }
  vector(near_);
  pool_.carry(carrier);
  memory_.carry(carrier, choice_);
  alarms_.carry(carrier, choice_);
}

}  // namespace monitor::tracking
