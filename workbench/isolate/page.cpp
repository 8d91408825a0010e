// A tracking as a report.
#include <fmt/format.h>

#include <filesystem>

#include "config/signals/nan.h"
#include "estimator/fdi/tracker/tracking_text.h"
#include "workbench/isolate/isolation.h"

namespace workbench::isolate {

namespace greybox = estimator::greybox;
namespace tracker = estimator::fdi::tracker;
namespace {

using present::Plot;
using present::Series;
using present::Tone;

using config::signals::kNaN;
constexpr double kInterval = 1.96;

Plot over_time(const IsolationReport& o, const std::string& title, const present::Axis& axis) {
  Plot plot;
  plot.title = title;
  plot.x = {"time", "s"};
  plot.y = axis;
  plot.zoom_group = "record";
  for (const WindowResult& window : o.windows) plot.x_values.push_back(window.t_s);
  return plot;
}

Plot parameter_plot(const IsolationReport& o, std::size_t i) {
  const greybox::FreeParameter& p = o.set.parameters[i];
  const bool relative = p.scale == greybox::ParameterScale::logarithmic;
  const double baseline = p.to_physical(o.baseline.theta[static_cast<Eigen::Index>(i)]);
  Plot plot = over_time(o, tracker::name_words(p.name),
                        relative ? present::Axis{"of the healthy value", "%"}
                                 : present::Axis{tracker::name_words(p.name), ""});
  const double factor = relative ? 100.0 / baseline : 1.0;
  Series value{"found", {}, {}, Tone::model, {}, false};
  Series low{"95 %, low", {}, {}, Tone::muted, {}, true};
  Series high{"95 %, high", {}, {}, Tone::muted, {}, true};
  for (const WindowResult& window : o.windows) {
    const tracking::ParameterEstimate& estimate = window.estimates[i];
    const double about = kInterval * estimate.std_error;
    value.y.push_back(estimate.valid ? factor * estimate.value : kNaN);
    low.y.push_back(estimate.valid ? factor * (estimate.value - about) : kNaN);
    high.y.push_back(estimate.valid ? factor * (estimate.value + about) : kNaN);
  }
  plot.series = {value, low, high};
  plot.lines = {{factor * baseline, "healthy"}};
  plot.caption = "Valid windows only, each at its last sample.";
  return plot;
}

Plot error_plot(const IsolationReport& o) {
  Plot plot = over_time(o, "Error of the fitted window", {"RMS", "um", true});
  Series error{"error", {}, {}, Tone::residual, {}, false};
  for (const WindowResult& window : o.windows) error.y.push_back(1e6 * window.rms_m);
  plot.series = {error};
  plot.lines = {{1e6 * o.settings.most_ratio * o.baseline.rms_m, "limit of valid windows"}};
  return plot;
}

present::Table alarm_table(const IsolationReport& o) {
  present::Table table;
  table.columns = {{"from", "s"},
                   {"to", "s"},
                   {"what", "", false},
                   {"confidence", ""},
                   {"or as well", "", false}};
  for (const DetectedChange& alarm : o.alarms) {
    table.rows.push_back({fmt::format("{:.2f}", alarm.raised_s),
                          alarm.active() ? "" : fmt::format("{:.2f}", alarm.cleared_s),
                          tracker::change_words(o.set, alarm.named, o.baseline.theta),
                          fmt::format("{:.4f}", std::min(alarm.confidence, 0.9999)),
                          tracker::group_words(o.set, alarm.named)});
  }
  return table;
}

}  // namespace

present::Report to_report(const IsolationReport& o) {
  present::Report page;
  page.title = "Isolation: " + std::filesystem::path(o.record).filename().string();
  std::size_t invalid = 0;
  for (const WindowResult& window : o.windows) invalid += window.valid ? 0 : 1;
  page.state = o.alarms.empty() ? present::ReportState::good : present::ReportState::warn;
  page.verdict = o.alarms.empty() ? "No change named."
                                  : std::to_string(o.alarms.size()) +
                                        (o.alarms.size() == 1 ? " change" : " changes") + " named.";
  page.summary = o.notes;
  page.facts = {{"windows", std::to_string(o.windows.size()), ""},
                {"invalid", std::to_string(invalid), ""},
                {"healthy error", fmt::format("{:.3g}", 1e6 * o.baseline.rms_m), "um"},
                {"noise floor", fmt::format("{:.3g}", 1e6 * o.noise_floor_m), "um"}};
  page.command = o.command;
  if (!o.alarms.empty()) {
    present::Section alarms;
    alarms.heading = "Changes";
    alarms.tables.push_back(alarm_table(o));
    page.sections.push_back(alarms);
  }
  present::Section course;
  course.heading = "Parameters over time";
  for (std::size_t i = 0; i < o.set.tracked; ++i) course.plots.push_back(parameter_plot(o, i));
  course.plots.push_back(error_plot(o));
  page.sections.push_back(course);
  return page;
}

}  // namespace workbench::isolate
