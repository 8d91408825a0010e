// How a window is fitted: with which samples, which parameters, which weights.
#include <algorithm>
#include <cmath>
#include <string>

#include "estimator/greybox/tracking/measured_parameter.h"
#include "estimator/greybox/tracking/parameter_tracker.h"
#include "estimator/greybox/tracking/words.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Standard error, search units, of what is held while the healthy rig is learnt.
constexpr double kHeld = 1e-4;

bool stands_still(const double* values, const Cut& cut) {
  const double* const first = values + cut.lead;
  return std::all_of(first, first + cut.samples, [first](double v) { return v == *first; });
}

}  // namespace

/// The latest samples; without chamber pressures, and why, where they cannot be right.
Cut Tracker::usable(std::size_t samples, std::string& left_out) const {
  const Cut cut = samples_.latest(samples);
  const bool wanted = choice_.supply_Pa() > 0.0 && (!healthy_ || healthy_->chambers.known());
  if (!wanted) return cut.without_pressures();
  if (cut.in_Pa == nullptr) {
    if (healthy_) {
      left_out = "chamber pressures left out because they were not read in the whole window";
    }
    return cut;
  }
  const bool in = stands_still(cut.in_Pa, cut);
  if (!in && !stands_still(cut.out_Pa, cut)) return cut;
  left_out = std::string("chamber pressures left out because the reading of the pressure ") +
             (in ? "in" : "out") + " stands still";
  return cut.without_pressures();
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
  WindowEstimate found = fit(cut, near_, {noise_floor_m_, {}});
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

}  // namespace estimator::greybox::tracking
