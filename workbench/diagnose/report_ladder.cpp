// The sections of the report that tell how the better model was found, and what it is.
#include <algorithm>
#include <cmath>

#include "workbench/diagnose/ladder.h"
#include "workbench/diagnose/quantity.h"
#include "workbench/diagnose/report_pages.h"
#include "workbench/diagnose/words.h"

namespace workbench::diagnose {
namespace {

using report::Column;
using report::Kind;
using report::Plot;
using report::Section;
using report::Table;
using report::Tone;

constexpr std::size_t kDrawnCandidates = 14;
/// Candidates that do worse than none by more than this are left to the table.
constexpr double kWorse = 1.05;
constexpr double kMicrometres = 1e6;

std::string joined(const std::vector<std::string>& effects) {
  std::string text;
  for (const std::string& effect : effects) text += (text.empty() ? "" : " + ") + effect;
  return text;
}

std::string micrometres(double length_m) {
  if (!std::isfinite(length_m)) return "";
  const double um = kMicrometres * length_m;
  return number(um < 1000.0 ? "%.3g" : "%.0f", um);
}

std::vector<report::ReferenceLine> floor_line(const Diagnosis& d) {
  if (!std::isfinite(d.noise_floor_m)) return {};
  return {{std::stod(micrometres(d.noise_floor_m)), "noise floor"}};
}

bool was_taken(const Candidate& candidate, std::vector<std::string> taken) {
  std::vector<std::string> effects = candidate.effects;
  std::sort(effects.begin(), effects.end());
  std::sort(taken.begin(), taken.end());
  return effects == taken;
}

Plot candidates_plot(const Diagnosis& d, std::size_t index) {
  const Round& round = d.ladder.rounds[index];
  Plot plot{.title = "Round " + std::to_string(index + 1),
            .kind = Kind::bars,
            .y = {"held-out error", "µm"},
            .lines = floor_line(d),
            .horizontal = true,
            .width = report::Width::half};
  plot.series.push_back({.name = "held-out error", .tone = Tone::model});
  for (const Candidate& candidate : round.candidates) {
    const bool worse = candidate.score_rms_m > kWorse * round.before.fitted.score_rms_m;
    if (!candidate.fitted_at_all || worse || plot.categories.size() == kDrawnCandidates) break;
    plot.categories.push_back(joined(candidate.effects));
    plot.series[0].y.push_back(kMicrometres * candidate.score_rms_m);
  }
  plot.categories.push_back("none of them");
  plot.series[0].y.push_back(kMicrometres * round.before.fitted.score_rms_m);
  return plot;
}

Table candidates_table(const Diagnosis& d, std::size_t index) {
  const Round& round = d.ladder.rounds[index];
  const std::vector<std::string> taken = taken_in(d.ladder, index);
  const std::string with =
      round.before.added.empty() ? "the model as given" : "with " + listed(round.before.added);
  Table table{
      .caption = "Round " + std::to_string(index + 1) + ", " + with,
      .columns = {Column{"effect", "", false}, Column{"held-out error", "µm"},
                  Column{"× noise floor", ""}, Column{"chance p", ""}, Column{"", "", false}}};
  for (const Candidate& candidate : round.candidates) {
    std::vector<std::string> row{joined(candidate.effects)};
    if (candidate.fitted_at_all) {
      row.push_back(micrometres(candidate.score_rms_m));
      row.push_back(times_words(candidate.score_rms_m / d.noise_floor_m));
      row.push_back(chance_words(candidate.p_value));
      row.emplace_back(!was_taken(candidate, taken) ? ""
                       : stayed(d.ladder, taken)    ? "taken"
                                                    : "taken, dropped later");
      if (was_taken(candidate, taken)) table.marked_rows.push_back(table.rows.size());
    } else {
      row.insert(row.end(), {"", "", "", "of no use at first sight, not fitted"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string change_words(double value, double before) {
  if (before == 0.0 || !std::isfinite(before) || !std::isfinite(value)) return "";
  return number("%+.1f", 100.0 * (value / before - 1.0));
}

}  // namespace

Section falling_error_section(const Outcome& outcome) {
  const Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The falling error"};
  section.paragraphs = {
      "RMS of measured less modelled position on data that were not fitted (" +
      split_words(outcome) +
      "), the slow drift of the integrating plant taken away by an observer. What the sensor's "
      "steps and noise leave even with a perfect model is the noise floor."};
  const std::vector<StepWords> steps = step_words(d);
  Plot plot{.title = "Held-out error, step by step",
            .kind = Kind::line,
            .y = {"held-out error", "µm", true},
            .lines = floor_line(d)};
  plot.series.push_back({.name = "held-out error", .tone = Tone::model});
  Table table{.columns = {Column{"step", "", false}, Column{"held-out error", "µm"},
                          Column{"× noise floor", ""}}};
  for (const StepWords& step : steps) {
    plot.categories.push_back(step.what);
    plot.series[0].y.push_back(kMicrometres * step.rms_m);
    table.rows.push_back(
        {step.what, micrometres(step.rms_m), times_words(step.rms_m / d.noise_floor_m)});
  }
  table.rows.push_back({"noise floor", micrometres(d.noise_floor_m), "1"});
  section.plots.push_back(std::move(plot));
  section.tables.push_back(std::move(table));
  return section;
}

Section candidates_section(const Outcome& outcome) {
  const Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The candidates"};
  section.paragraphs = {
      "Each round fits every absent effect together with all that the model has already, and "
      "scores it on held-out data. An effect is taken when it lowers that error by " +
      number("%g", 100.0 * kWorthwhile) +
      " % or more and the gain is more than chance (p, one-sided)."};
  for (std::size_t i = 0; i < d.ladder.rounds.size(); ++i) {
    Plot plot = candidates_plot(d, i);
    if (plot.categories.size() > 1) section.plots.push_back(std::move(plot));
    section.tables.push_back(candidates_table(d, i));
  }
  return section;
}

Section parameters_section(const Outcome& outcome) {
  const Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The better model's parameters"};
  section.paragraphs = {
      "Fitted to all samples. The error is one standard error; none is given for a value at its "
      "bound."};
  if (!outcome.output.empty()) section.paragraphs.push_back("Written to " + outcome.output + ".");
  Table table{.columns = {Column{"parameter", "", false}, Column{"value"}, Column{"± std. error"},
                          Column{"unit", "", false}, Column{"in the file"}, Column{"change", "%"},
                          Column{"", "", false}}};
  plant_sim::ModelFile file = outcome.shop.model;
  for (const ParameterValue& p : d.parameters) {
    const Quantity q = quantity(p.name, p.value, p.std_error);
    const double* before = file.value(p.name);
    const bool added = was_added(d, p.name);
    const bool known = before != nullptr && !added;
    const std::string in_file = known ? quantity(p.name, *before, std::nan(""), p.value).value : "";
    if (added) table.marked_rows.push_back(table.rows.size());
    table.rows.push_back({p.name, q.value, q.error, typeset(" " + q.unit).substr(1), in_file,
                          known ? change_words(p.value, *before) : "",
                          std::string(added ? "new" : "") + (p.at_bound ? " at its bound" : "")});
  }
  section.tables.push_back(std::move(table));
  return section;
}

Section where_section(const Outcome& outcome) {
  Section section{.heading = "Where the rest enters"};
  section.paragraphs = {
      "The remaining residual, explained by smooth functions of one variable each, as a flow, a "
      "force, a change of the gain or an error of the measurement; scored on held-out data."};
  Table table{.columns = {Column{"enters", "", false}, Column{"variable", "", false},
                          Column{"explains of its square", "%"}}};
  for (const Where& where : outcome.diagnosis.where) {
    table.rows.push_back(
        {where.enters, where.variable, number("%.1f", 100.0 * where.explained_ratio)});
  }
  if (!table.rows.empty()) table.marked_rows = {0};
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace workbench::diagnose
