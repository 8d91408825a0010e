#include "workbench/live/online_residual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/validation/comparison.h"
#include "estimator/residual/noise_floor.h"
#include "workbench/present/compare_units.h"
#include "workbench/present/printed_axis.h"

namespace workbench::live {

namespace validation = estimator::greybox::validation;
namespace {

using config::signals::kNaN;
constexpr double kLargestInitialisationGain = 0.5;  // share of the error, in one sample

}  // namespace

OnlineResidual::OnlineResidual(const plant_sim::ModelFile& model, double observer_per_s)
    : model_(model), observer_per_s_(observer_per_s) {
  plant_sim::require_constant(model);
}

void OnlineResidual::add(std::int64_t tick, double sample_time_s, double u_V, double y_m) {
  if (sample_time_s != sample_time_s_) {
    samples_.clear();
    sample_time_s_ = sample_time_s;
    ensemble_ = plant_sim::make_ensemble(model_, greybox::step_for(model_, sample_time_s));
  }
  const bool starts = samples_.empty() || tick != samples_.back().tick + 1;
  if (starts && !samples_.empty() && tick <= samples_.back().tick) samples_.clear();
  if (starts) {
    in_segment_ = 0;
    ensemble_->start(y_m);
  }
  const double error_m = y_m - ensemble_->reading_m()[0];
  // A segment begins with unknown speed and pressures.
  const bool settles = in_segment_ < std::llround(greybox::kSettling_s / sample_time_s_);
  double share = observer_per_s_ * sample_time_s_;
  if (settles) {
    share = std::max(share, std::min(kLargestInitialisationGain,
                                     greybox::kInitialisation_per_s * sample_time_s_));
  }
  plant_sim::Ensemble::Values by_m;
  by_m.fill(share * error_m);
  ensemble_->shift(by_m);
  plant_sim::Ensemble::Values held_V;
  held_V.fill(u_V);
  ensemble_->advance(held_V, sample_time_s_);
  ++in_segment_;
  samples_.push_back({tick, u_V, y_m, settles ? kNaN : error_m, starts});
  const auto most = std::max(1LL, std::llround(kLong_s / sample_time_s_));
  while (samples_.back().tick - samples_.front().tick >= most) samples_.pop_front();
}

ResidualFigures OnlineResidual::figures() const {
  const present::PrintedAxis axis(present::motion_of(model_));
  ResidualFigures f;
  f.rms_m = f.fit_percent = f.noise_floor_m = f.floor_ratio = kNaN;
  f.worst_from = f.worst_to = f.worst_rms_m = kNaN;
  if (samples_.empty()) {
    f.t_s = kNaN;
    f.note = "no samples yet";
    return f;
  }
  f.t_s = static_cast<double>(samples_.back().tick) * sample_time_s_;
  const std::int64_t first = samples_.back().tick - std::llround(kShort_s / sample_time_s_) + 1;
  double n = 0.0;
  double squares = 0.0;
  double sum_m = 0.0;
  double sum_squares = 0.0;
  double origin_m = samples_.back().y_m;
  std::vector<double> y_m;
  for (const Sample& s : samples_) {
    if (s.tick < first) continue;
    if (s.starts) y_m.push_back(kNaN);
    y_m.push_back(s.y_m);
    if (std::isnan(s.error_m)) continue;
    n += 1.0;
    squares += s.error_m * s.error_m;
    sum_m += s.y_m - origin_m;
    sum_squares += (s.y_m - origin_m) * (s.y_m - origin_m);
  }
  f.window_s = n * sample_time_s_;
  if (n < 2.0) {
    f.note = "the model settles";
    return f;
  }
  f.rms_m = std::sqrt(squares / n);
  const double spread_m = std::sqrt(std::max(0.0, sum_squares / n - sum_m * sum_m / (n * n)));
  if (spread_m > 0.0) f.fit_percent = 100.0 * (1.0 - f.rms_m / spread_m);
  const double floor_m = estimator::residual::noise_floor(y_m, sample_time_s_).sd_m;
  f.noise_floor_m = std::max(floor_m, greybox::kLeastFloor_m);
  f.floor_ratio = f.rms_m / f.noise_floor_m;
  find_worst(f);
  return f;
}

void OnlineResidual::find_worst(ResidualFigures& f) const {
  config::record::Record record;
  record.name = "the last " + std::to_string(std::lround(kLong_s)) + " s";
  record.sample_time_s = sample_time_s_;
  for (const Sample& s : samples_) {
    if (s.starts && !record.t_s.empty()) record.gaps.push_back(record.t_s.size());
    record.t_s.push_back(static_cast<double>(s.tick) * sample_time_s_);
    record.u_V.push_back(s.u_V);
    record.y_m.push_back(s.y_m);
  }
  try {
    const validation::Comparison c =
        validation::compare(model_, greybox::dataset_of(record), observer_per_s_);
    // Regions stand out in what a gain and an offset do not explain; where these are all that is
    // wrong, since a fault say, the healthy part stands out, and is not the worst.
    constexpr double kLeastShare = 0.5;
    std::vector<validation::SignificantRegion> regions = c.worst;
    regions.insert(regions.begin(), c.headline);
    const auto worst = std::find_if(regions.begin(), regions.end(), [&](const auto& region) {
      return region.significant && !region.ranges.empty() &&
             region.figures.rms_m >= kLeastShare * c.rms_m;
    });
    if (worst == regions.end()) return;
    for (validation::RegionRange& one : worst->ranges) {
      one.lowest = one.lowest && one.variable != "time";  // samples begin with no record
    }
    f.worst_spans = compare::region_spans(c, *worst);
    const validation::RegionRange& range = worst->ranges.front();
    f.worst = present::where(*worst);
    f.worst_variable = range.variable;
    f.worst_from = range.from;
    f.worst_to = range.to;
    f.worst_rms_m = worst->figures.rms_m;
  } catch (const config::schema::Error& e) {
    f.note = e.what();
  }
}

std::string line_of(const ResidualFigures& f) {
  std::string line = fmt::format(
      "{:9.1f} s  rms {:9} fit {:>7}  {:>6} x floor", f.t_s, config::units::length_words(f.rms_m),
      std::isfinite(f.fit_percent) ? config::units::three_digits(f.fit_percent) + " %" : "-",
      config::units::three_digits(f.floor_ratio));
  if (!f.worst.empty())
    line += "  worst " + f.worst + " (" + config::units::length_words(f.worst_rms_m) + ")";
  if (!f.note.empty()) line += "  " + f.note;
  return line;
}

std::string json_of(const ResidualFigures& f) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json line;
  line["t_s"] = number(f.t_s);
  line["window_s"] = number(f.window_s);
  line["rms_m"] = number(f.rms_m);
  line["fit_percent"] = number(f.fit_percent);
  line["noise_floor_m"] = number(f.noise_floor_m);
  line["floor_ratio"] = number(f.floor_ratio);
  line["worst"] = nullptr;
  if (!f.worst.empty()) {
    line["worst"] = {{"where", f.worst},
                     {"variable", f.worst_variable},
                     {"from", number(f.worst_from)},
                     {"to", number(f.worst_to)},
                     {"rms_m", number(f.worst_rms_m)}};
  }
  line["note"] = f.note.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(f.note);
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace workbench::live
