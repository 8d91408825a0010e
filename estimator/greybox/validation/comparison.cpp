#include "estimator/greybox/validation/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/validation/speed_response.h"
#include "estimator/residual/noise_floor.h"
#include "estimator/residual/whiteness.h"

namespace estimator::greybox::validation {
namespace {

using config::signals::kNaN;
/// Spread of the positions, in noise floors, below which the rod does not move.
constexpr double kLeastMotion = 10.0;
constexpr double kLeastMotion_m = 1e-9;
/// Ratio to the greatest magnitude above which a command is at its limit.
constexpr double kAtLimit = 0.999;
constexpr double kOftenLimited = 0.1;
constexpr double kAlwaysLimited = 0.9;

/// `values` with NaN between segments and where `counts` is 0.
std::vector<double> broken(const Dataset& record, const std::vector<double>& values,
                           bool valid_only) {
  std::vector<double> series;
  for (const SampleRange& span : segments(record)) {
    if (span.begin > 0) series.push_back(kNaN);
    for (std::size_t k = span.begin; k < span.end; ++k) {
      series.push_back(valid_only && record.valid[k] == 0 ? kNaN : values[k]);
    }
  }
  return series;
}

struct Run {
  std::vector<double> errors_m;
  PlantStart start;
};

Run run(const plant_sim::ModelFile& model, const Dataset& record, double observer_per_s) {
  Dataset all = record;
  std::fill(all.valid.begin(), all.valid.end(), char{1});
  ObserverSimulation run(model, all, {}, observer_per_s);
  Eigen::MatrixXd residual_m;
  run.residuals(Eigen::MatrixXd(0, 1), residual_m);
  std::vector<double> errors_m(record.size());
  for (std::size_t k = 0; k < errors_m.size(); ++k) {
    errors_m[k] = residual_m(static_cast<Eigen::Index>(k), 0);
  }
  return {std::move(errors_m), run.plant_start()};
}

double rms(const std::vector<double>& values, const std::vector<char>& counts) {
  double squares = 0.0;
  double n = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (counts[k] == 0) continue;
    squares += values[k] * values[k];
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(squares / n) : kNaN;
}

double spread(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / n);
}

void require_motion(const Dataset& record, double noise_m) {
  const double sd_m = spread(record.y_m);
  const double least_m = std::max(kLeastMotion_m, std::isfinite(noise_m) ? noise_m : 0.0);
  const auto [low, high] = std::minmax_element(record.y_m.begin(), record.y_m.end());
  // Noise of n samples spans 7 to 10 standard deviations.
  if (sd_m < kLeastMotion * least_m && *high - *low < 2.0 * kLeastMotion * least_m) {
    throw config::schema::bad_data(
        record.name,
        fmt::format("the {} does not move: y stays within {:.3g} {} of itself",
                    config::units::moving_part(), 1e6 * (*high - *low),
                    config::units::axis_unit("um")),
        "a record with motion well above the position's noise");
  }
}

void note_command(Comparison& c) {
  const std::vector<double>& u_V = c.record.u_V;
  const auto [low, high] = std::minmax_element(u_V.begin(), u_V.end());
  if (!(*high > *low)) {
    c.command.limited_share = 1.0;
    c.command.limitation = CommandRange::Limitation::constant;
    c.command.most_V = *low;
    return;
  }
  const double most_V = std::max(std::abs(*low), std::abs(*high));
  const auto at_limit = std::count_if(u_V.begin(), u_V.end(),
                                      [&](double u) { return std::abs(u) >= kAtLimit * most_V; });
  c.command.limited_share = static_cast<double>(at_limit) / static_cast<double>(u_V.size());
  c.command.most_V = most_V;
  if (c.command.limited_share > kAlwaysLimited) {
    c.command.limitation = CommandRange::Limitation::always_limited;
  } else if (c.command.limited_share > kOftenLimited) {
    c.command.limitation = CommandRange::Limitation::often_limited;
  }
}

void note_stroke(Comparison& c, const plant_sim::ModelFile& model) {
  for (const plant_sim::NamedValue& parameter : model.parameters) {
    if (parameter.name != "stroke_m") continue;
    c.stroke_m = parameter.value;
    const auto [low, high] = std::minmax_element(c.record.y_m.begin(), c.record.y_m.end());
    if (*low < 0.0 || *high > parameter.value) {
      c.beyond_stroke = StrokeExcess{*low, *high, parameter.value};
    }
  }
}

void find_speed_error(Comparison& c, PlantStart start) {
  c.speed_error_mps.assign(c.record.size(), 0.0);
  for (const SampleRange& span : segments(c.record)) {
    for (std::size_t k = span.begin; k + 1 < span.end; ++k) {
      const double kept = 1.0 - c.record.observer_gain(k, c.observer_per_s, start).position;
      c.speed_error_mps[k] = (c.error_m[k + 1] - kept * c.error_m[k]) / c.record.sample_time_s;
    }
  }
}

std::size_t half_window(const Comparison& c) {
  return static_cast<std::size_t>(
      std::max(1L, std::lround(kHalfWindow_s / c.record.sample_time_s)));
}

void find_arising(Comparison& c) {
  const std::size_t half = half_window(c);
  const double sample_time_s = c.record.sample_time_s;
  c.local_velocity_error_mps.assign(c.record.size(), 0.0);
  for (const SampleRange& span : segments(c.record)) {
    for (std::size_t k = span.begin; k < span.end; ++k) {
      const std::size_t from = k - std::min(half, k - span.begin);
      const std::size_t to = std::min(k + half, span.end - 1);
      double sum_mps = 0.0;
      for (std::size_t i = from; i < to; ++i) sum_mps += c.speed_error_mps[i];
      const double steps = static_cast<double>(to - from);
      const double mean_mps = sum_mps / steps;
      const double modelled_mps =
          (c.record.y_m[to] - c.record.y_m[from]) / (steps * sample_time_s) - mean_mps;
      c.local_velocity_error_mps[k] =
          mean_mps - c.systematic.gain_ratio * modelled_mps - c.systematic.offset_mps;
    }
  }
}

void find_regions(Comparison& c) {
  SortedErrors sorted;
  sorted.record = &c.record;
  sorted.kinematics = &c.kinematics;
  sorted.error_m = &c.error_m;
  sorted.speed_error_mps = &c.speed_error_mps;
  sorted.local_velocity_error_mps = &c.local_velocity_error_mps;
  sorted.counts = c.record.valid;
  const double window_s = 2.0 * static_cast<double>(half_window(c)) * c.record.sample_time_s;
  sorted.noise_mps =
      std::isfinite(c.noise_floor_m) ? std::sqrt(2.0) * c.noise_floor_m / window_s : 0.0;
  c.regions = sort_by_region(sorted);
  c.worst = significant_regions(sorted, c.regions);
  c.headline = narrowed(sorted, c.regions, c.worst);
}

}  // namespace

double Comparison::duration_s() const {
  return static_cast<double>(record.size()) * record.sample_time_s;
}

ModelErrors errors_of(const plant_sim::ModelFile& model, const Dataset& record,
                      double observer_per_s) {
  ModelErrors errors;
  Run observed = run(model, record, observer_per_s);
  errors.start = observed.start;
  errors.error_m = std::move(observed.errors_m);
  errors.free_error_m = run(model, record, 0.0).errors_m;
  errors.rms_m = rms(errors.error_m, record.valid);
  errors.free_run_rms_m = rms(errors.free_error_m, std::vector<char>(record.size(), 1));
  errors.fit_percent = 100.0 * (1.0 - errors.free_run_rms_m / spread(record.y_m));
  return errors;
}

Comparison compare(const plant_sim::ModelFile& model, const Dataset& record,
                   double observer_per_s) {
  Comparison c;
  c.model = model.name;
  c.record = record;
  c.observer_per_s = observer_per_s;
  const estimator::residual::NoiseFloor floor =
      estimator::residual::noise_floor(broken(record, record.y_m, false), record.sample_time_s);
  c.noise_floor_m = std::max(floor.sd_m, kLeastFloor_m);  // NaN stays NaN
  c.encoder_step_m = floor.encoder_step_m;
  require_motion(record, floor.sd_m);
  note_command(c);
  note_stroke(c, model);
  ModelErrors errors = errors_of(model, record, observer_per_s);
  c.error_m = std::move(errors.error_m);
  c.free_error_m = std::move(errors.free_error_m);
  c.rms_m = errors.rms_m;
  c.free_run_rms_m = errors.free_run_rms_m;
  c.fit_percent = errors.fit_percent;
  c.k_step = k_step_errors(model, record);
  const std::vector<double> residual = broken(record, c.error_m, true);
  c.whiteness_p = estimator::residual::whiteness(residual).p;
  c.independence_p =
      estimator::residual::independence(residual, broken(record, record.u_V, false)).p;
  c.kinematics = greybox::kinematics(record, std::isfinite(floor.sd_m) ? floor.sd_m : 0.0);
  find_speed_error(c, errors.start);
  c.systematic =
      systematic_error(record, c.error_m, c.speed_error_mps, observer_per_s, errors.start);
  c.motion = motion_ratio(record, c.error_m, observer_per_s, errors.start);
  c.response = command_response(record.sample_time_s, record.u_V, record.y_m, record.starts);
  c.resonance = missing_resonance(record, c.free_error_m, c.noise_floor_m);
  find_arising(c);
  find_regions(c);
  return c;
}

}  // namespace estimator::greybox::validation
