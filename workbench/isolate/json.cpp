// A tracking as JSON.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/fdi/tracker/tracking_text.h"
#include "workbench/isolate/isolation.h"
#include "workbench/present/json.h"

namespace workbench::isolate {

namespace greybox = estimator::greybox;
namespace tracker = estimator::fdi::tracker;
namespace {

using Eigen::Index;
using nlohmann::ordered_json;
using present::number_or_null;

ordered_json json_of(const tracking::ProcessNoise& noise, const tracking::DisturbanceLevel& level) {
  ordered_json lines = ordered_json::array();
  for (std::size_t i = 0; i < noise.model.lines.size(); ++i) {
    const auto& line = noise.model.lines[i];
    lines.push_back({{"as", noise.site_name(line.site)},
                     {"frequency_Hz", line.frequency_Hz},
                     {"amplitude", number_or_null(level.line_values[i])}});
  }
  return {{"as", noise.site_name(tracking::LineSite::force)},
          {"value", number_or_null(level.random)},
          {"corner_Hz", number_or_null(noise.model.noise.corner_Hz)},
          {"lines", lines}};
}

ordered_json json_of(const WindowResult& window, const IsolationReport& o) {
  const ParameterSet& set = o.set;
  ordered_json out{{"t_s", window.t_s}, {"from_s", window.from_s}};
  for (std::size_t i = 0; i < set.tracked; ++i) {
    const tracking::ParameterEstimate& estimate = window.estimates[i];
    out[set.parameters[i].name] = {{"value", number_or_null(estimate.value)},
                                   {"std_error", number_or_null(estimate.std_error)},
                                   {"smallest", number_or_null(estimate.smallest)},
                                   {"valid", estimate.valid}};
  }
  out["correlation"] = ordered_json::array();
  for (Index i = 0; i < window.correlation.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Index j = 0; j < window.correlation.cols(); ++j) {
      row.push_back(number_or_null(window.correlation(i, j)));
    }
    out["correlation"].push_back(row);
  }
  out["rms_m"] = number_or_null(window.rms_m);
  if (std::isfinite(window.in.rms_Pa)) {
    out["pressures"] = {{"in_error_Pa", number_or_null(window.in.rms_Pa)},
                        {"in_offset_Pa", number_or_null(window.in.mean_Pa)},
                        {"out_error_Pa", number_or_null(window.out.rms_Pa)},
                        {"out_offset_Pa", number_or_null(window.out.mean_Pa)}};
  }
  if (window.left_out) out["left_out"] = tracker::left_out_words(window.left_out);
  out["valid"] = window.valid;
  out["why"] = tracker::invalid_words(set, window.invalid);
  if (window.level) out["disturbance"] = json_of(*o.baseline.noise, *window.level);
  if (window.part) out["part"] = tracker::part_words(set, *window.part);
  return out;
}

ordered_json json_of(const DetectedChange& alarm, const IsolationReport& o) {
  const ParameterChange& named = alarm.named;
  const greybox::FreeParameter& p = o.set.parameters[named.parameter];
  const double baseline = p.to_physical(o.baseline.theta[static_cast<Index>(named.parameter)]);
  const double value = p.to_physical(named.theta);
  ordered_json group = ordered_json::array({p.name});
  ordered_json rivals = ordered_json::array();
  for (const Rival& rival : named.rivals) {
    group.push_back(rival.name);
    rivals.push_back({{"parameter", rival.name}, {"value", number_or_null(rival.value)}});
  }
  return {{"parameter", p.name},
          {"direction", value > baseline ? "high" : "low"},
          {"value", number_or_null(value)},
          {"std_error", number_or_null(named.std_error * p.slope(named.theta))},
          {"healthy", number_or_null(baseline)},
          {"change_ratio", number_or_null(baseline != 0.0 ? value / baseline - 1.0 : NAN)},
          {"confidence", number_or_null(alarm.confidence)},
          {"ambiguity_group", named.rivals.empty() ? ordered_json::array() : group},
          {"rivals", rivals},
          {"raised_s", alarm.raised_s},
          {"cleared_s", number_or_null(alarm.cleared_s)},
          {"advice", tracker::advice_words(o.set, named)},
          {"words", tracker::change_words(o.set, named, o.baseline.theta)}};
}

double median_fit_s(std::vector<WindowResult> windows) {
  if (windows.empty()) return NAN;
  const auto middle = windows.begin() + static_cast<std::ptrdiff_t>(windows.size() / 2);
  std::nth_element(windows.begin(), middle, windows.end(),
                   [](const WindowResult& a, const WindowResult& b) { return a.fit_s < b.fit_s; });
  return middle->fit_s;
}

}  // namespace

std::string to_json(const IsolationReport& o) {
  ordered_json out{{"model", o.model}, {"record", o.record}, {"command", o.command}};
  ordered_json names = ordered_json::array();
  ordered_json values = ordered_json::object();
  for (std::size_t i = 0; i < o.set.tracked; ++i) {
    const greybox::FreeParameter& p = o.set.parameters[i];
    names.push_back(p.name);
    values[p.name] = number_or_null(p.to_physical(o.baseline.theta[static_cast<Index>(i)]));
  }
  out["parameters"] = names;
  out["noise_floor_m"] = number_or_null(o.noise_floor_m);
  out["healthy"] = {{"learnt", o.learnt},
                    {"from_s", o.learnt ? number_or_null(o.baseline_from_s) : nullptr},
                    {"to_s", o.learnt ? number_or_null(o.baseline_to_s) : nullptr},
                    {"rms_m", number_or_null(o.baseline.rms_m)},
                    {"values", values}};
  const tracking::ChamberErrors& chambers = o.baseline.chambers;
  if (chambers.known()) {
    out["healthy"]["pressures"] = {{"in_error_Pa", chambers.in.rms_Pa},
                                   {"in_offset_Pa", chambers.in.offset_Pa},
                                   {"out_error_Pa", chambers.out.rms_Pa},
                                   {"out_offset_Pa", chambers.out.offset_Pa},
                                   {"offset_sd_Pa", chambers.offset_sd_Pa}};
  }
  if (o.baseline.noise) {
    out["healthy"]["disturbance"] = json_of(*o.baseline.noise, o.baseline.noise->healthy);
    ordered_json errors = ordered_json::object();
    for (std::size_t i = 0; i < o.set.tracked; ++i) {
      const greybox::FreeParameter& p = o.set.parameters[i];
      const auto at = static_cast<Index>(i);
      errors[p.name] = number_or_null(std::sqrt(o.baseline.noise->covariance(at, at)) *
                                      p.slope(o.baseline.theta[at]));
    }
    out["healthy"]["std_errors"] = errors;
  }
  out["limit_m"] = number_or_null(o.settings.most_ratio * o.baseline.rms_m);
  out["alarms"] = ordered_json::array();
  for (const DetectedChange& alarm : o.alarms) out["alarms"].push_back(json_of(alarm, o));
  out["windows"] = ordered_json::array();
  for (const WindowResult& window : o.windows) out["windows"].push_back(json_of(window, o));
  out["notes"] = o.notes;
  out["fit_s"] = number_or_null(median_fit_s(o.windows));
  return out.dump(2) + "\n";
}

}  // namespace workbench::isolate
