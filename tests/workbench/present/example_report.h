// A report as compare and diagnose would fill it, from formulas: 30 s at 200 Hz with a gap.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "workbench/present/report.h"

namespace workbench::present {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct ExampleData {
  std::vector<double> t_s, measured_mm, model_mm, residual_um, velocity_mmps, command_V;
};

inline ExampleData example_data(std::size_t n) {
  ExampleData d;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 2.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / 200.0;
    const double w = 2.0 * std::numbers::pi * 0.25;
    const double y = 40.0 * std::sin(w * t) + 12.0 * std::sin(2.7 * w * t);
    const double v = 40.0 * w * std::cos(w * t) + 12.0 * 2.7 * w * std::cos(2.7 * w * t);
    const bool gap = n > 3000 && i > 2000 && i < 2120;
    const double residual = 14.0 * std::tanh(v / 6.0) + 0.05 * y + noise(random);
    d.t_s.push_back(t);
    d.measured_mm.push_back(gap ? kNan : y);
    d.model_mm.push_back(y - residual * 1e-3 * 60.0);
    d.residual_um.push_back(gap ? kNan : residual);
    d.velocity_mmps.push_back(v);
    d.command_V.push_back(std::round((v / 12.0 + 0.3) * 204.8) / 204.8);
  }
  return d;
}

/// RMS of y in equal stretches of x.
inline present::Series binned_rms(const std::vector<double>& x, const std::vector<double>& y,
                                  double low, double high, int bins) {
  std::vector<double> sum(static_cast<std::size_t>(bins)), count(sum.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = (x[i] - low) / (high - low) * bins;
    if (!(at >= 0.0 && at < bins) || !std::isfinite(y[i])) continue;
    sum[static_cast<std::size_t>(at)] += y[i] * y[i];
    count[static_cast<std::size_t>(at)] += 1.0;
  }
  present::Series series{
      .name = "RMS per stretch", .tone = present::Tone::measured, .kind = present::PlotKind::line};
  for (std::size_t b = 0; b < sum.size(); ++b) {
    series.x.push_back(low + (high - low) * (static_cast<double>(b) + 0.5) / bins);
    series.y.push_back(count[b] > 0.0 ? std::sqrt(sum[b] / count[b]) : kNan);
  }
  return series;
}

inline present::Plot time_plot(const std::string& title, const present::Axis& y,
                               const ExampleData& d, std::vector<present::Series> series) {
  return {.title = title,
          .x = {"time", "s"},
          .y = y,
          .x_values = d.t_s,
          .series = std::move(series),
          .zoom_group = "time"};
}

inline present::Plot cloud(const std::string& title, const present::Axis& x,
                           const std::vector<double>& values, double reach, const ExampleData& d) {
  return {.title = title,
          .kind = present::PlotKind::scatter,
          .x = x,
          .y = {"residual", "µm"},
          .x_values = values,
          .series = {{.name = "sample", .y = d.residual_um, .tone = present::Tone::residual},
                     binned_rms(values, d.residual_um, -reach, reach, 30)},
          .width = present::PlotWidth::half};
}

inline present::Section where_section(const ExampleData& d) {
  present::Section section{
      .heading = "Where it fails",
      .paragraphs = {"The model fails below 5 mm/s and while reversing: the residual "
                     "follows the sign of the velocity, not its size."}};
  section.plots.push_back(
      cloud("Residual against velocity", {"velocity", "mm/s"}, d.velocity_mmps, 110.0, d));
  section.plots.push_back(
      cloud("Residual against position", {"position", "mm"}, d.measured_mm, 52.0, d));
  section.plots.push_back(cloud("Residual against command", {"command", "V"}, d.command_V, 9.0, d));
  present::Plot whiteness{.title = "Autocorrelation of the residual",
                          .kind = present::PlotKind::bars,
                          .x = {"lag", "s"},
                          .y = {"correlation", ""},
                          .lines = {{0.026, "95 % limit"}},
                          .width = present::PlotWidth::half};
  whiteness.series.push_back({.name = "correlation", .tone = present::Tone::model});
  for (int k = 0; k < 50; ++k) {
    whiteness.x_values.push_back(0.02 * k);
    whiteness.series[0].y.push_back(std::exp(-0.05 * k) * std::cos(0.15 * k));
  }
  section.plots.push_back(whiteness);
  section.tables.push_back({.caption = "Worst regions",
                            .columns = {{"variable", "", false},
                                        {"from"},
                                        {"to"},
                                        {"unit", "", false},
                                        {"RMS", "µm"},
                                        {"share", "%"}},
                            .rows = {{"velocity", "−5.0", "5.0", "mm/s", "13.4", "38.2"},
                                     {"direction", "reversing", "", "", "11.9", "21.0"},
                                     {"position", "30.0", "40.0", "mm", "9.7", "8.3"}},
                            .marked_rows = {0}});
  return section;
}

inline present::Section ladder_section() {
  present::Section section{
      .heading = "What is missing",
      .paragraphs = {"Every absent effect was fitted and scored on held-out stretches "
                     "of the record. Bars that reach the dashed line explain all that "
                     "the sensor lets one see."}};
  section.plots.push_back({.title = "Error step by step",
                           .kind = present::PlotKind::line,
                           .x = {"", ""},
                           .y = {"held-out RMS", "µm", true},
                           .categories = {"as given", "+ null_bias", "+ friction", "refitted"},
                           .series = {{.name = "held-out RMS",
                                       .y = {412.0, 38.5, 3.1, 2.56},
                                       .tone = present::Tone::model}},
                           .lines = {{2.5, "noise floor"}},
                           .width = present::PlotWidth::half});
  section.plots.push_back(
      {.title = "Candidates, first round",
       .kind = present::PlotKind::bars,
       .y = {"held-out RMS", "µm"},
       .categories = {"friction", "backlash", "quadratic_damping", "deadband", "supply_droop",
                      "internal_leakage", "load_force", "entrained_air", "force_ripple"},
       .series = {{.name = "held-out RMS",
                   .y = {3.1, 9.8, 21.4, 24.0, 30.2, 33.8, 36.9, 38.2, 38.4},
                   .tone = present::Tone::model}},
       .lines = {{2.5, "noise floor"}},
       .horizontal = true,
       .width = present::PlotWidth::half});
  section.tables.push_back(
      {.caption = "Parameters",
       .columns = {{"parameter", "", false},
                   {"value"},
                   {"± std. error"},
                   {"unit", "", false},
                   {"95 % interval"},
                   {"remark", "", false}},
       .rows = {{"friction.coulomb_N", "182.4", "0.9", "N", "180.6 … 184.2", ""},
                {"friction.static_N", "240", "11", "N", "218 … 262", "weakly seen"},
                {"null_bias.offset_V", "0.0312", "0.0002", "V", "0.0308 … 0.0316", ""}}});
  return section;
}

inline present::Report example_report(std::size_t n = 6000) {
  const ExampleData d = example_data(n);
  present::Report report{
      .title = "rig_2000psi.toml against bench_0412.csv",
      .verdict = "Friction is missing: 182 ± 2 N of Coulomb friction on the rod.",
      .state = present::ReportState::warn,
      .summary = {"The model fails below 5 mm/s and while reversing. With friction "
                  "added, the error on held-out data falls from 38.5 µm to 2.6 µm, "
                  "1.02 times the noise floor."},
      .facts = {{"Error before", "38.5", "µm"},
                {"Error after", "2.56", "µm"},
                {"Noise floor", "2.50", "µm"},
                {"Fit", "99.98", "%"},
                {"Record", "30.0", "s at 200 Hz"}},
      .command =
          "spoolwatch diagnose rig_2000psi.toml bench_0412.csv "
          "--report report.html -o rig_better.toml",
      .made_at = "2026-03-02 14:05"};
  present::Section overview{.heading = "Measured against model"};
  overview.plots.push_back(
      time_plot("Position", {"position", "mm"}, d,
                {{.name = "measured", .y = d.measured_mm, .tone = present::Tone::measured},
                 {.name = "model", .y = d.model_mm, .tone = present::Tone::model}}));
  overview.plots[0].caption = "The record has a gap from 10.0 to 10.6 s; nothing is drawn there.";
  overview.plots.push_back(
      time_plot("Residual", {"measured − model", "µm"}, d,
                {{.name = "residual", .y = d.residual_um, .tone = present::Tone::residual}}));
  overview.plots.back().lines = {{2.5, "noise floor"}};
  overview.plots.push_back(time_plot("Command", {"command", "V"}, d,
                                     {{.name = "command",
                                       .y = d.command_V,
                                       .tone = present::Tone::muted,
                                       .kind = present::PlotKind::steps}}));
  report.sections = {overview, where_section(d), ladder_section()};
  return report;
}

}  // namespace workbench::present
