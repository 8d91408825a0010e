#include "estimator/greybox/tracking/parameter_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "config/units/quantity.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/tracking/words.h"

namespace estimator::greybox::tracking {
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
                                    const config::signals::Pressures& pressures) {
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
      const Cut with = std::exchange(cut, cut.without_pressures());
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

bool Tracker::look_at_part(Window& window, const Cut& whole) {
  Eigen::VectorXd near = healthy_->x;
  for (const double share : kParts) {
    const auto samples = static_cast<std::size_t>(share * static_cast<double>(window_));
    std::string left_out;
    Cut cut = usable(samples, left_out);
    if (whole.in_Pa == nullptr) cut = cut.without_pressures();
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

void Tracker::serialize(estimator::StateArchive& archive) {
  const auto vector = [&archive](Eigen::VectorXd& x) {
    for (double& value : x) archive.value(value);
  };
  samples_.serialize(archive);
  archive.value(until_);
  archive.value(pressures_out_);
  bool knows = healthy_.has_value();
  archive.value(knows);
  if (archive.restores()) {
    healthy_.reset();
    if (knows) healthy_ = Healthy{0.0, choice_.file, {}};
  }
  if (healthy_) {
    archive.value(healthy_->rms_m);
    vector(healthy_->x);
    healthy_->chambers.serialize(archive);
  }
  slow_.serialize(archive);
  vector(near_);
  pool_.serialize(archive);
  memory_.serialize(archive, choice_);
  alarms_.serialize(archive, choice_);
}

}  // namespace estimator::greybox::tracking
