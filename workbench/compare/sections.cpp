#include <filesystem>

#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "workbench/compare/comparison_report.h"
#include "workbench/present/compare_units.h"
#include "workbench/present/dynamics_plots.h"
#include "workbench/present/record_section.h"

namespace workbench::compare {

namespace units = config::units;

namespace greybox = estimator::greybox;
namespace {

using present::Plot;
using present::PlotKind;
using present::PlotWidth;
using present::Section;
using present::Series;
using present::Tone;

using config::signals::kNaN;

/// Values times a factor, with a break between segments; of settled samples only where asked.
template <class F>
std::vector<double> series(const greybox::Dataset& record, F value, bool valid_only = false) {
  std::vector<double> out;
  for (const greybox::SampleRange& span : greybox::segments(record)) {
    if (span.begin > 0) out.push_back(kNaN);
    for (std::size_t k = span.begin; k < span.end; ++k) {
      out.push_back(valid_only && record.valid[k] == 0 ? kNaN : value(k));
    }
  }
  return out;
}

std::vector<double> times(const greybox::Dataset& record) {
  std::vector<double> out;
  for (const greybox::SampleRange& span : greybox::segments(record)) {
    if (span.begin > 0) out.push_back(0.5 * (record.t_s[span.begin - 1] + record.t_s[span.begin]));
    for (std::size_t k = span.begin; k < span.end; ++k) out.push_back(record.t_s[k]);
  }
  return out;
}

Plot over_time(const validation::Comparison& c, const std::string& title, const present::Axis& y,
               const std::string& prefix) {
  return present::over_time(times(c.record), title, y, prefix + "time");
}

Series named(const std::string& name, Tone tone, std::vector<double> y) {
  Series s;
  s.name = name;
  s.y = std::move(y);
  s.tone = tone;
  return s;
}

Section time_section(const validation::Comparison& c, const std::string& prefix) {
  const greybox::Dataset& r = c.record;
  Section section;
  section.heading = "Over time";
  section.paragraphs = {present::kFreeRunMeaning, present::kDriftCorrectedMeaning,
                        present::kNoiseFloorMeaning};
  Plot position = over_time(c, "Position", {"position", "mm"}, prefix);
  present::add_series(position, "measured", Tone::measured,
                      series(r, [&](auto k) { return 1e3 * r.y_m[k]; }));
  present::add_series(position, "model, free run", Tone::model,
                      series(r, [&](auto k) { return 1e3 * (r.y_m[k] - c.free_error_m[k]); }));
  const present::ErrorUnit unit = present::error_unit(c.rms_m);
  Plot error = over_time(c, "Error, drift-corrected", {"measured less model", unit.name}, prefix);
  present::add_series(error, "error", Tone::residual,
                      series(
                          r, [&](auto k) { return unit.per_m * c.error_m[k]; }, true));
  present::add_noise_band(error, c.noise_floor_m, unit.per_m);
  const present::ErrorUnit free_unit = present::error_unit(c.free_run_rms_m);
  Plot free =
      over_time(c, "Error of the free run", {"measured less model", free_unit.name}, prefix);
  present::add_series(free, "error", Tone::accent,
                      series(r, [&](auto k) { return free_unit.per_m * c.free_error_m[k]; }));
  Plot command = over_time(c, "Command", {"command", "V"}, prefix);
  present::add_series(command, "command", Tone::muted, series(r, [&](auto k) { return r.u_V[k]; }));
  section.plots = {position, error, free, command};
  return section;
}

present::Table worst_table(const validation::Comparison& c) {
  present::Table table;
  table.caption =
      "The range of each variable that stands out most, the most telling first. In bold: beyond "
      "chance.";
  table.columns = {{"where", "", false},
                   {"error RMS", "um"},
                   {"speed error RMS", "mm/s"},
                   {"of the speed error", "%"},
                   {"of the time", "%"}};
  for (const validation::SignificantRegion& failing : c.worst) {
    if (failing.significant) table.marked_rows.push_back(table.rows.size());
    table.rows.push_back({present::where(failing), units::three_digits(1e6 * failing.figures.rms_m),
                          units::three_digits(1e3 * failing.figures.local_velocity_error_rms_mps),
                          units::three_digits(100.0 * failing.figures.local_velocity_error_share),
                          units::three_digits(100.0 * failing.figures.time_share)});
  }
  return table;
}

Section where_section(const validation::Comparison& c) {
  Section section;
  section.heading = "Where it fails";
  section.paragraphs.push_back(
      "The position adds up the speed: an error of position still shows long after it arose. The "
      "speed error, by how much the model's speed is off at the moment, shows where it arises. The "
      "bars show its RMS" +
      std::string(c.systematic.cause == validation::ErrorCause::neither
                      ? "."
                      : ", after what a plain gain and offset would explain has been taken off."));
  section.tables_first = true;
  section.tables.push_back(worst_table(c));
  for (const validation::Region& region : c.regions) {
    const present::DisplayUnit unit = present::unit_of(region.variable);
    Plot plot;
    plot.title = std::string("By ") + unit.name;
    plot.kind = PlotKind::bars;
    plot.width = PlotWidth::half;
    plot.x = {unit.name, unit.text};
    plot.y = {"speed error RMS", "mm/s"};
    Series bars = named("speed error RMS", Tone::residual, {});
    for (const validation::Bin& bin : region.bins) {
      plot.categories.push_back(present::bin_text(region.variable, bin));
      bars.y.push_back(1e3 * bin.local_velocity_error_rms_mps);
    }
    plot.series.push_back(bars);
    section.plots.push_back(plot);
  }
  return section;
}

Plot against(const validation::Comparison& c, const std::string& variable,
             const std::vector<double>& values) {
  const present::DisplayUnit unit = present::unit_of(variable);
  const greybox::Dataset& r = c.record;
  Plot plot;
  plot.title = std::string("Against ") + unit.name;
  plot.kind = PlotKind::scatter;
  plot.width = PlotWidth::half;
  plot.x = {unit.name, unit.text};
  plot.y = {"speed error", "mm/s"};
  plot.x_values = series(
      r, [&](auto k) { return unit.factor * values[k]; }, true);
  const Series cloud =
      named("speed error", Tone::residual,
            series(
                r, [&](auto k) { return 1e3 * c.local_velocity_error_mps[k]; }, true));
  const present::Binned curves = present::binned(plot.x_values, cloud.y);
  plot.series = {cloud, curves.mean, curves.rms};
  return plot;
}

Section against_section(const validation::Comparison& c) {
  Section section;
  section.heading = "The residual against each variable";
  section.paragraphs.push_back(
      "A shape here is physics that the model lacks: a step at zero velocity is dry friction, a "
      "level that is not zero is an offset, a bend is something that grows with speed. The curves "
      "are "
      "mean and RMS over equal stretches.");
  section.plots = {against(c, "v", c.kinematics.speed_mps), against(c, "u", c.record.u_V),
                   against(c, "y", c.record.y_m),
                   against(c, "acceleration", c.kinematics.acceleration_mps2)};
  return section;
}

Section dynamics_section(const validation::Comparison& c) {
  const greybox::Dataset& r = c.record;
  Section section;
  section.heading = "By frequency";
  section.paragraphs = {present::kDynamicsMeaning};
  if (c.resonance) section.paragraphs.push_back(present::resonance_words(*c.resonance));
  present::NamedValues error{"residual", Tone::residual, c.error_m};
  present::NamedValues model{"model", Tone::model, r.y_m};
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (r.valid[k] == 0) error.values[k] = kNaN;
    model.values[k] -= c.free_error_m[k];
  }
  section.plots = present::response_plots(r, {model}, c.noise_floor_m);
  if (section.plots.empty()) {
    section.paragraphs.emplace_back(
        "The motion excites too few frequencies for a response to be told.");
  }
  section.plots.push_back(present::spectrum_plot(r, {error}, c.noise_floor_m));
  section.plots.push_back(present::autocorrelation_plot(r, {error}));
  return section;
}

present::Table number_table(const validation::Comparison& c, const DisturbanceCheck& check) {
  present::Table table;
  table.columns = {{"figure", "", false}, {"value", ""}, {"meaning", "", false}};
  const std::string gain = units::three_digits(c.observer_per_s);
  table.rows.push_back(
      {"drift-corrected RMS", units::length_words(c.rms_m),
       "driven by the measured command; the position corrected towards the measured one "
       "at " +
           gain + " 1/s"});
  table.rows.push_back({"free-run RMS", units::length_words(c.free_run_rms_m),
                        "simulation from each segment's first sample, nothing corrected"});
  table.rows.push_back({"fit", units::three_digits(c.fit_percent) + " %",
                        "100 (1 - |error| / |y - mean|), of the free run"});
  for (const validation::KStep& k : c.k_step) {
    table.rows.push_back({std::to_string(k.samples) + " ahead, RMS", units::length_words(k.rms_m),
                          "position put on the measured one that many samples before"});
  }
  if (check.found) {
    table.rows.push_back({"sensor and disturbance", units::length_words(check.found->floor_m),
                          "error that they cause, whatever the model"});
  }
  table.rows.push_back({"noise floor", units::length_words(c.noise_floor_m),
                        "noise and rounding of the position, from its own samples"});
  table.rows.push_back({"whiteness p", units::chance_words(c.whiteness_p),
                        "small: the residual is more than noise (Ljung-Box)"});
  table.rows.push_back({"independence p", units::chance_words(c.independence_p),
                        "small: the residual depends on earlier commands"});
  return table;
}

Section number_section(const validation::Comparison& c, const DisturbanceCheck& check) {
  Section section;
  section.heading = "The numbers and how they are computed";
  section.tables.push_back(number_table(c, check));
  section.paragraphs.push_back(
      "Velocity and acceleration: a parabola through the measured positions of 50 ms to either "
      "side. At rest: below " +
      units::speed_words(c.kinematics.rest_mps) + ". Reversing: from 50 ms before the " +
      units::moving_part() +
      " leaves one direction until 50 ms after it goes the "
      "other way. The first half second of each segment does not count, except in the free run. "
      "The speed error is a mean over 50 ms to either side.");
  for (const std::string& note : notes(c)) section.paragraphs.push_back("Note: " + note + ".");
  return section;
}

}  // namespace

std::vector<Section> sections(const validation::Comparison& c, const std::string& prefix,
                              const DisturbanceCheck& check) {
  return {time_section(c, prefix), where_section(c), against_section(c), dynamics_section(c),
          number_section(c, check)};
}

present::Report make_report(const validation::Comparison& c, const std::string& command,
                            const DisturbanceCheck& check) {
  const Words said = words(c, check);
  present::Report made;
  made.title = c.model + " against " + std::filesystem::path(c.record.name).filename().string();
  made.verdict = said.verdict;
  made.summary = said.lines;
  made.state = said.judgement == Judgement::at_floor  ? present::ReportState::good
               : said.judgement == Judgement::useless ? present::ReportState::bad
                                                      : present::ReportState::warn;
  const auto fact = [&](const char* label, double metres) {
    const std::string said_so = units::length_words(metres);  // as in the words: "381 um"
    const auto gap = said_so.rfind(' ');
    if (gap == std::string::npos) return;
    made.facts.push_back({label, said_so.substr(0, gap), said_so.substr(gap + 1)});
  };
  fact("drift-corrected RMS", c.rms_m);
  if (check.found) fact("sensor and disturbance", check.found->floor_m);
  fact("noise floor", c.noise_floor_m);
  fact("free-run RMS", c.free_run_rms_m);
  made.facts.push_back({"fit of the free run", units::three_digits(c.fit_percent), "%"});
  fact("one-step prediction, RMS", c.k_step.front().rms_m);
  made.command = command;
  made.sections = sections(c, "", check);
  return made;
}

}  // namespace workbench::compare
