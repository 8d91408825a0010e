// Fits of a window: samples, free parameters, weights.
#include <algorithm>
#include <cmath>

#include "estimator/greybox/tracking/measured_parameter.h"
#include "estimator/greybox/tracking/parameter_tracker.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Standard error, search units, of a held parameter while the baseline is learned.
constexpr double kHeld = 1e-4;

bool stands_still(const double* values, const WindowData& data) {
  const double* const first = values + data.lead;
  return std::all_of(first, first + data.samples, [first](double v) { return v == *first; });
}

}  // namespace

/// The latest samples; without chamber pressures, and with the reason, where they cannot be right.
WindowData ParameterTracker::usable(std::size_t samples, PressuresLeftOut& left_out) const {
  const WindowData data = samples_.latest(samples);
  const bool wanted = set_.supply_Pa() > 0.0 && (!baseline_ || baseline_->chambers.known());
  if (!wanted) return data.without_pressures();
  if (data.in_Pa == nullptr) {
    if (baseline_) left_out.cause = PressuresLeftOut::Cause::not_read;
    return data;
  }
  const bool in = stands_still(data.in_Pa, data);
  if (!in && !stands_still(data.out_Pa, data)) return data;
  left_out.cause =
      in ? PressuresLeftOut::Cause::inlet_still : PressuresLeftOut::Cause::outlet_still;
  return data.without_pressures();
}

HeldParameters ParameterTracker::held(const WindowData& data, const ErrorScales& errors) const {
  HeldParameters out;
  if (supply_ == kNotMeasured) return out;
  if (samples_.supply_Pa(data.samples) != nullptr) {
    out.measured = supply_;
  } else if (baseline_ ? baseline_->chambers.known() && !with_chambers(data, errors)
                       : data.in_Pa != nullptr) {
    out.baseline = gain_;
  }
  return out;
}

WindowFitSummary ParameterTracker::fit(const WindowData& data, Eigen::VectorXd near,
                                       const ErrorScales& errors) {
  const HeldParameters held = this->held(data, errors);
  std::vector<std::size_t> free = set_.tracked_indices();
  const auto hold = [&](std::size_t parameter, double theta) {
    near[static_cast<Index>(parameter)] = theta;
    free.erase(std::find(free.begin(), free.end(), parameter));
  };
  if (held.baseline != kNotMeasured) {
    const auto at = static_cast<Index>(held.baseline);
    hold(held.baseline, baseline_ ? baseline_->theta[at] : set_.file[at]);
    return with_held(fit_.fit(data, free, near, errors), held.baseline,
                     baseline_ ? INFINITY : kHeld);
  }
  if (held.measured == kNotMeasured) return fit_.fit(data, free, near, errors);
  const FreeParameter& p = set_.parameters[held.measured];
  const MeasuredMean read = measured_mean(samples_.supply_Pa(data.samples), data.samples);
  const double at = p.to_theta(read.mean);
  hold(held.measured, at);
  return with_held(fit_.fit(data, free, near, errors), held.measured, read.std_error / p.slope(at));
}

WindowFitSummary ParameterTracker::first_fit(const WindowData& data) {
  WindowFitSummary found = fit(data, near_, {noise_floor_m_, {}});
  if (data.in_Pa == nullptr) return found;
  const double supply_Pa = set_.supply_Pa();
  const ChamberErrors one_Pa{{1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, 0.0};
  const WindowFitSummary seen = fit_.fit(data, {}, found.theta, {noise_floor_m_, one_Pa});
  ChamberErrors own;
  own.in.rms_Pa = std::max(seen.in.rms_Pa, kLeastError_ratio * supply_Pa);
  own.out.rms_Pa = std::max(seen.out.rms_Pa, kLeastError_ratio * supply_Pa);
  own.in.weight_Pa = own.in.rms_Pa;
  own.out.weight_Pa = own.out.rms_Pa;
  own.offset_sd_Pa = supply_Pa;  // unlimited
  return fit(data, found.theta, {std::max(noise_floor_m_, found.rms_m), own});
}

Misfit ParameterTracker::misfit(const WindowFitSummary& found, double most_ratio) const {
  return baseline_ ? misfit_of(found, baseline_->errors(), most_ratio) : Misfit{};
}

std::optional<ExcitationDesign> ParameterTracker::probe() {
  if (!settings_.probe.given() || !baseline_) return std::nullopt;
  plant_sim::ModelFile baseline = model_;
  for (std::size_t i = 0; i < set_.tracked; ++i) {
    const FreeParameter& p = set_.parameters[i];
    if (double* value = baseline.value(p.name)) {
      *value = p.to_physical(baseline_->theta[static_cast<Index>(i)]);
    }
  }
  return design_excitation(
      baseline, settings_.probe, lead_ + window_, sample_time_s_, baseline_->rms_m,
      [this](const double* u_V, const double* y_m) {
        WindowData data{u_V, y_m, lead_, window_};
        if (disturbed_) {
          data.gains =
              disturbed_->noise.gains(data, baseline_->theta, present_noise(), baseline_->rms_m);
        }
        return fit_.fit(data, set_.tracked_indices(), baseline_->theta, {baseline_->rms_m, {}})
            .std_error;
      });
}

}  // namespace estimator::greybox::tracking
