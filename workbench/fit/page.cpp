// A fit as a report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/schema/joined.h"
#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "estimator/nonlinear/profile.h"
#include "workbench/fit/fit_report.h"
#include "workbench/present/record_section.h"

namespace workbench::fit {
namespace {

using config::signals::kNaN;
using present::add_series;
using present::Plot;
using present::Section;
using present::Tone;

std::string file_name(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

/// One record's part of the long series, NaN where it does not count and at gaps.
std::vector<double> part(const Eigen::VectorXd& series, std::size_t start,
                         const greybox::Dataset& record, double factor, bool valid_only) {
  std::vector<double> out(record.size(), kNaN);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (valid_only && record.valid[i] == 0) continue;
    out[i] = factor * series[static_cast<Eigen::Index>(start + i)];
  }
  for (const std::size_t begin : record.starts) {
    if (begin > 0) out[begin] = kNaN;
  }
  return out;
}

Plot over_time(const greybox::Dataset& record, const std::string& title,
               const present::Axis& axis) {
  return present::over_time(record.t_s, title, axis, record.name);
}

Section record_section(const FitReport& o, std::size_t r) {
  const greybox::FitDataset& data = o.prepared->problem.data;
  const greybox::Dataset& record = data.records[r];
  const std::size_t start = data.starts[r];
  const greybox::EstimationSummary& e = o.estimation;
  Section section;
  section.heading = "Record " + file_name(record.name);
  if (r == 0) {
    section.paragraphs = {present::kFreeRunMeaning, present::kDriftCorrectedMeaning,
                          present::kNoiseFloorMeaning};
  }
  const Eigen::Map<const Eigen::VectorXd> y(record.y_m.data(),
                                            static_cast<Eigen::Index>(record.size()));
  const auto modelled = [&](const Eigen::VectorXd& error_m) {
    Eigen::VectorXd all = -error_m;
    all.segment(static_cast<Eigen::Index>(start), y.size()) += y;
    return part(all, start, record, 1e3, false);
  };
  Plot position = over_time(record, "Position, free run", {"position", "mm"});
  std::vector<double> measured_mm = record.y_m;
  for (double& value : measured_mm) value *= 1e3;
  add_series(position, "measured", Tone::measured, std::move(measured_mm));
  add_series(position, "model as it was", Tone::muted, modelled(e.before.free_run_m));
  add_series(position, "fitted model", Tone::model, modelled(e.after.free_run_m));
  section.plots.push_back(position);
  for (const bool fitted : {false, true}) {
    const greybox::SimulationErrors& errors = fitted ? e.after : e.before;
    const present::ErrorUnit unit = present::error_unit(errors.rms_m);
    Plot plot = over_time(
        record,
        fitted ? "Error after the fit, drift-corrected" : "Error before the fit, drift-corrected",
        {"measured less model", unit.name});
    add_series(plot, "error, drift-corrected", fitted ? Tone::improved : Tone::residual,
               part(errors.residual_m, start, record, unit.per_m, true));
    present::add_noise_band(plot, o.noise_floor_m, unit.per_m);
    section.plots.push_back(plot);
  }
  Plot command = over_time(record, "Command", {"command", "V"});
  add_series(command, "command", Tone::muted, record.u_V);
  section.plots.push_back(command);
  return section;
}

Section parameter_section(const greybox::EstimationSummary& e) {
  Section section;
  section.heading = "Parameters";
  section.paragraphs.push_back(
      "Standard errors allow for residuals of any colour; the 95 % interval is that of the "
      "likelihood profile where one was computed. The record's share tells how much of what is "
      "known comes from the record rather than from the prior.");
  present::Table table;
  table.columns = {{"parameter", "", false}, {"start", ""},           {"fitted", ""},
                   {"± std. error", ""},     {"95 % from", ""},       {"to", ""},
                   {"unit", "", false},      {"record's share", "%"}, {"remark", "", false}};
  for (const greybox::EstimatedParameter& p : e.parameters) {
    const std::string& name = p.free.name;
    const config::units::Quantity q = config::units::quantity(name, p.value, p.std_error, p.start);
    const double largest = std::max(std::abs(p.value), std::abs(p.start));
    // The ends of the interval with the digits of the value.
    const auto shown = [&](double value) {
      if (std::isnan(value)) return std::string("-");
      return config::units::quantity(name, value, p.std_error, largest).value;
    };
    table.rows.push_back({name, config::units::quantity(name, p.start, kNaN, largest).value,
                          q.value, q.error, shown(p.low), shown(p.high), q.unit,
                          fmt::format("{:.0f}", 100.0 * p.record_share), remark(p)});
    if (p.at_bound != 0) table.marked_rows.push_back(table.rows.size() - 1);
  }
  section.tables.push_back(table);
  section.tables_first = true;
  return section;
}

Section sight_section(const greybox::EstimationSummary& e) {
  Section section;
  section.heading = "Parameters that the record does not determine";
  for (const bool after : {false, true}) {
    const greybox::IdentifiabilityReport& report =
        after ? e.identifiability_after : e.identifiability_before;
    const std::string text =
        after ? "After the fit: " : "Before the fit, at the model file's values: ";
    const auto words = [&e](const greybox::UnidentifiableParameter& unseen) {
      return unidentifiable_words(unseen, e.parameters);
    };
    const std::string list = config::schema::joined_by(report.unidentifiable, words, "; ");
    section.paragraphs.push_back(
        text + (list.empty() ? "every fitted parameter is determined" : list) +
        fmt::format(". Condition of the scaled Jacobian: {:.3g}.", report.condition));
  }
  present::Table table;
  table.caption = "Correlation of the estimates";
  table.columns.push_back({"", "", false});
  for (const greybox::EstimatedParameter& p : e.parameters)
    table.columns.push_back({p.free.name, ""});
  for (Eigen::Index i = 0; i < e.correlation.rows(); ++i) {
    std::vector<std::string> row{e.parameters[static_cast<std::size_t>(i)].free.name};
    for (Eigen::Index j = 0; j < e.correlation.cols(); ++j) {
      const double value = e.correlation(i, j);
      row.push_back(std::isnan(value) ? "-" : fmt::format("{:.2f}", value));
    }
    table.rows.push_back(row);
  }
  section.tables.push_back(table);
  return section;
}

Section profile_section(const greybox::EstimationSummary& e) {
  Section section;
  section.heading = "Profiles of the likelihood";
  section.paragraphs.push_back(
      "Rise of the least cost when one parameter is held away from its best value and all others "
      "are fitted again. The 95 % interval ends where the rise reaches 3.84. Where the curve is a "
      "parabola, the standard error describes the uncertainty.");
  for (const greybox::EstimatedParameter& p : e.parameters) {
    if (p.profile.size() < 3) continue;
    Plot plot;
    plot.title = p.free.name;
    plot.width = present::PlotWidth::half;
    plot.x = {p.free.name, config::units::unit_of(p.free.name)};
    plot.y = {"rise of the cost", ""};
    present::Series series;
    series.name = "profile";
    series.tone = Tone::model;
    for (const auto& point : p.profile) {
      if (!std::isfinite(point.value) || point.rise > 5.0 * estimator::nonlinear::kProfile95)
        continue;
      plot.x_values.push_back(point.value);
      series.y.push_back(point.rise);
    }
    plot.series.push_back(series);
    plot.lines.push_back({estimator::nonlinear::kProfile95, "95 %"});
    plot.caption = to_string(p.doubt);
    section.plots.push_back(plot);
  }
  return section;
}

}  // namespace

present::Report to_report(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  const std::vector<std::string> said = words(o);
  present::Report made;
  made.title = o.prepared->problem.model.name + " fitted to " +
               config::schema::joined_by(record_names(o), file_name);
  made.verdict = said.front();
  for (std::size_t i = 1; i < said.size();
       ++i) {  // unidentifiable parameters have a section of their own
    if (said[i].rfind("Parameters that the record does not determine", 0) != 0)
      made.summary.push_back(said[i]);
  }
  const bool at_floor = std::isfinite(o.noise_floor_m) && e.after.rms_m < 1.15 * o.noise_floor_m;
  made.state = at_floor && !e.interrupted ? present::ReportState::good : present::ReportState::warn;
  const auto fact = [&](const char* label, double metres) {
    const present::ErrorUnit unit = present::error_unit(metres);
    made.facts.push_back({label, fmt::format("{:.3g}", unit.per_m * metres), unit.name});
  };
  fact("error before", e.before.rms_m);
  fact("error after", e.after.rms_m);
  if (std::isfinite(e.after.heldout_rms_m)) fact("not fitted, after", e.after.heldout_rms_m);
  if (std::isfinite(o.noise_floor_m)) fact("noise floor", o.noise_floor_m);
  made.facts.push_back({"fit of the free run", fmt::format("{:.4g}", e.after.fit_percent), "%"});
  made.command = o.prepared->command;
  made.sections.push_back(parameter_section(e));
  for (std::size_t r = 0; r < o.prepared->problem.data.records.size(); ++r) {
    made.sections.push_back(record_section(o, r));
  }
  const auto profiled = [](const greybox::EstimatedParameter& p) { return p.profile.size() > 2; };
  if (std::any_of(e.parameters.begin(), e.parameters.end(), profiled)) {
    made.sections.push_back(profile_section(e));
  }
  made.sections.push_back(sight_section(e));
  return made;
}

}  // namespace workbench::fit
