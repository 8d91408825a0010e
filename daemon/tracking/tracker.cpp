#include "daemon/tracking/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

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
/// Standard error, search units, of what is held while the healthy rig is learnt.
constexpr double kHeld = 1e-4;

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

/// The same window without its pressures.
Cut alone(Cut cut) {
  cut.in_Pa = nullptr;
  cut.out_Pa = nullptr;
  return cut;
}

bool stands_still(const double* values, const Cut& cut) {
  const double* const first = values + cut.lead;
  return std::all_of(first, first + cut.samples, [first](double v) { return v == *first; });
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
      gain_(tracked_index(choice, "valve_gain_m_per_V")),
      stride_(std::max<std::size_t>(1, samples_in(settings.stride_s, sample_time_s))),
      fit_(model, choice.parameters, sample_time_s, lead_ + window_, settings.observer_per_s),
      samples_(lead_, window_),
      slow_(choice, settings.following),
      near_(choice.file),
      pool_(choice.tracked, (window_ + stride_ - 1) / stride_,
            static_cast<std::size_t>(std::max<std::int64_t>(1, settings.pooled))),
      alarms_(choice, settings.thresholds) {}

void Tracker::take(const Healthy& healthy) {
  healthy_ = healthy;
  slow_.take(healthy.x);
  near_ = healthy.x;
}

std::optional<Window> Tracker::push(double t_s, double u_V, double y_m, bool first,
                                    const estimator::fdi::Pressures& pressures) {
  if (first) {
    samples_.clear();
    until_ = samples_.needed();
    pool_.clear();
  }
  samples_.push(u_V, y_m, pressures);
  if (until_ > 0) --until_;
  if (until_ > 0 || !samples_.enough()) return std::nullopt;
  until_ = stride_;
  return look(t_s);
}

/// The latest samples; without chamber pressures, and why, where they cannot be right.
Cut Tracker::usable(std::size_t samples, std::string& left_out) const {
  Cut cut = samples_.latest(samples);
  if (cut.in_Pa == nullptr) {
    if (healthy_ && healthy_->chambers.known()) {
      left_out = "chamber pressures left out because they were not read in the whole window";
    }
    return cut;
  }
  const bool in = stands_still(cut.in_Pa, cut);
  if (in || stands_still(cut.out_Pa, cut)) {
    left_out = std::string("chamber pressures left out because the reading of the pressure ") +
               (in ? "in" : "out") + " stands still";
  }
  return in || !left_out.empty() || !(choice_.supply_Pa() > 0.0) ? alone(cut) : cut;
}

Held Tracker::held(const Cut& cut, const Errors& errors) const {
  Held out;
  if (supply_ == kNotMeasured) return out;
  if (samples_.supply_Pa(cut.samples) != nullptr) {
    out.measured = supply_;
  } else if (healthy_ ? healthy_->chambers.known() && !with_chambers(cut, errors)
                      : cut.in_Pa != nullptr) {
    out.healthy = gain_;
  }
  return out;
}

WindowEstimate Tracker::fit(const Cut& cut, Eigen::VectorXd near, const Errors& errors) {
  const Held held = this->held(cut, errors);
  std::vector<std::size_t> free = choice_.tracked_indices();
  const auto hold = [&](std::size_t parameter, double x) {
    near[static_cast<Index>(parameter)] = x;
    free.erase(std::find(free.begin(), free.end(), parameter));
  };
  if (held.healthy != kNotMeasured) {
    const auto at = static_cast<Index>(held.healthy);
    hold(held.healthy, healthy_ ? healthy_->x[at] : choice_.file[at]);
    return with_held(fit_.fit(cut, free, near, errors), held.healthy, healthy_ ? INFINITY : kHeld);
  }
  if (held.measured == kNotMeasured) return fit_.fit(cut, free, near, errors);
  const SearchParameter& p = choice_.parameters[held.measured];
  const Reading read = reading_of(samples_.supply_Pa(cut.samples), cut.samples);
  const double at = p.search(read.mean);
  hold(held.measured, at);
  return with_held(fit_.fit(cut, free, near, errors), held.measured, read.std_error / p.slope(at));
}

WindowEstimate Tracker::first_fit(const Cut& cut) {
  const WindowEstimate found = fit(cut, near_, {noise_floor_m_, {}});
  if (cut.in_Pa == nullptr) return found;
  const double supply_Pa = choice_.supply_Pa();
  const ChamberErrors one_Pa{{1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, 0.0};
  const WindowEstimate seen = fit_.fit(cut, {}, found.x, {noise_floor_m_, one_Pa});
  ChamberErrors own;
  own.in.rms_Pa = std::max(seen.in.rms_Pa, kLeastError_ratio * supply_Pa);
  own.out.rms_Pa = std::max(seen.out.rms_Pa, kLeastError_ratio * supply_Pa);
  own.in.weight_Pa = own.in.rms_Pa;
  own.out.weight_Pa = own.out.rms_Pa;
  own.offset_sd_Pa = supply_Pa;  // any
  return fit(cut, found.x, {std::max(noise_floor_m_, found.rms_m), own});
}

std::string Tracker::misfit(const WindowEstimate& found, double most_ratio) const {
  return healthy_ ? misfit_words(found, healthy_->errors(), most_ratio) : std::string();
}

Window Tracker::look(double t_s) {
  Window window;
  window.t_s = t_s;
  window.from_s = t_s - static_cast<double>(window_ - 1) * sample_time_s_;
  Cut cut = usable(window_, window.left_out);
  const auto begin = std::chrono::steady_clock::now();
  WindowEstimate found = healthy_ ? fit(cut, near_, healthy_->errors()) : first_fit(cut);
  window.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  window.evaluations = found.evaluations;
  std::string misfit = this->misfit(found, settings_.most_ratio);
  if (misfit.empty()) pressures_out_ = false;
  bool part = false;
  if (!misfit.empty() && moves(cut) && found.with_chambers()) {
    part = look_at_part(window, cut);
    if (!part) {
      const Cut with = std::exchange(cut, alone(cut));
      const Errors errors = healthy_->errors();
      WindowEstimate instead = fit(cut, near_, errors);
      if (this->misfit(instead, settings_.most_ratio).empty()) {
        // Which of the two it is shows where they have not drawn the fit to them.
        const std::string shown =
            this->misfit(fit_.fit(with, {}, instead.x, errors), settings_.most_ratio);
        if (!shown.empty()) misfit = shown;
        window.left_out = "chamber pressures left out because " + misfit;
        pressures_out_ = true;
        misfit.clear();
        found = std::move(instead);
      }
    }
  }
  window.rms_m = found.rms_m;
  window.in = found.in;
  window.out = found.out;
  window.correlation = found.correlation;
  window.fits = misfit.empty();
  window.explained = moves(cut) && window.fits;
  estimate(window, found);
  judge(window, cut, found, misfit);
  if (window.explained) near_ = found.x;
  if (!healthy_ || !moves(cut)) return window;
  if (window.fits) {
    tell(window, cut, found);
  } else if (!part && (pressures_out_ || !found.with_chambers())) {
    look_at_part(window, cut);
  }
  slow_.follow(window, window.fits, alarms_, healthy_->x);
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

void Tracker::judge(Window& window, const Cut& cut, const WindowEstimate& found,
                    const std::string& misfit) const {
  std::string why;
  if (!moves(cut)) {
    why = still_words(motion_m(cut), noise_m(), settings_.window_s);
  } else if (!window.explained) {
    why = misfit;
  }
  bool unseen = false;
  for (std::size_t i = 0; i < choice_.tracked; ++i) {
    Estimate& one = window.estimates[i];
    const SearchParameter& p = choice_.parameters[i];
    const double most =
        p.scale == Scale::logarithmic ? settings_.most_std_error : settings_.most_of_typical;
    one.why = why;
    if (why.empty() && i == gain_ && !window.left_out.empty() &&
        std::isinf(found.std_error[static_cast<Index>(i)])) {
      one.why = "position alone does not tell valve gain from supply pressure: " + window.left_out;
    } else if (why.empty()) {
      one.why = unseen_words(choice_, found, i, one.std_error / p.slope(one.x), most);
      unseen = unseen || !one.why.empty();
    }
    one.valid = one.why.empty();
    if (window.why.empty()) window.why = one.why;
  }
  window.valid = window.why.empty();
  window.poor = !moves(cut) || (window.explained && unseen);
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
                               {healthy_->rms_m, {}})
                          .std_error;
                    });
}

bool Tracker::look_at_part(Window& window, const Cut& whole) {
  Eigen::VectorXd near = healthy_->x;
  for (const double share : kParts) {
    const auto samples = static_cast<std::size_t>(share * static_cast<double>(window_));
    std::string left_out;
    Cut cut = usable(samples, left_out);
    if (whole.in_Pa == nullptr) cut = alone(cut);
    const WindowEstimate part = fit(cut, near, healthy_->errors());
    const double most = std::max(
        settings_.most_ratio, 1.0 + kChanceOfRms / std::sqrt(2.0 * static_cast<double>(samples)));
    if (!misfit(part, most).empty()) continue;
    if (!moves(cut)) return true;
    window.part = part_words(choice_, part, static_cast<double>(samples) * sample_time_s_);
    tell(window, cut, part);
    near_ = part.x;
    return true;
  }
  return false;
}

void Tracker::tell(Window& window, const Cut& cut, const WindowEstimate& found) {
  const bool whole = cut.samples == window_;
  Memory once;  // the rivals of a part are not those of the whole window
  const Errors errors = healthy_->errors();
  window.named = name_changes(fit_, choice_, cut, found, healthy_->x, errors, settings_.thresholds,
                              whole ? memory_ : once, held(cut, errors));
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
  pressures_out_ = false;
  alarms_ = AlarmBook(choice_, settings_.thresholds);
}

void Tracker::carry(estimator::Carrier& carrier) {
  const auto vector = [&carrier](Eigen::VectorXd& x) {
    for (double& value : x) carrier.value(value);
  };
  samples_.carry(carrier);
  carrier.value(until_);
  carrier.value(pressures_out_);
  bool knows = healthy_.has_value();
  carrier.value(knows);
  if (carrier.restores()) {
    healthy_.reset();
    if (knows) healthy_ = Healthy{0.0, choice_.file, {}};
  }
  if (healthy_) {
    carrier.value(healthy_->rms_m);
    vector(healthy_->x);
    healthy_->chambers.carry(carrier);
  }
  slow_.carry(carrier);
  vector(near_);
  pool_.carry(carrier);
  memory_.carry(carrier, choice_);
  alarms_.carry(carrier, choice_);
}

}  // namespace monitor::tracking
