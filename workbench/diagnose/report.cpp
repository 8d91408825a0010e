// Sections of the report on the better model and on the search that found it.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/selection/structure_search.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/report_sections.h"
#include "workbench/diagnose/search_rounds.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"
#include "workbench/present/record_section.h"

namespace workbench::diagnose {
namespace {

using present::Column;
using present::Plot;
using present::PlotKind;
using present::Section;
using present::Table;
using present::Tone;

constexpr std::size_t kDrawnCandidates = 14;
/// Candidates that do worse than none by more than this are left to the table.
constexpr double kWorse = 1.05;

/// One unit for all errors of a page: millimetres where even the least is one or more.
struct LengthScale {
  double per_m = 1e6;
  const char* unit = "µm";

  /// Three digits, "27.0"; whole from 1000 on.
  [[nodiscard]] std::string words(double length_m) const {
    if (!std::isfinite(length_m)) return "";
    const double shown = per_m * length_m;
    std::string text =
        shown < 1000.0 ? fmt::format("{:#.3g}", shown) : fmt::format("{:.0f}", shown);
    if (text.back() == '.') text.pop_back();
    return text;
  }
};

LengthScale scale_of(const selection::Diagnosis& d) {
  constexpr double kMillimetre_m = 1e-3;
  return std::min(d.rms_before_m, d.rms_after_m) >= kMillimetre_m ? LengthScale{1e3, "mm"}
                                                                  : LengthScale{};
}

std::vector<present::ReferenceLine> floor_line(const selection::Diagnosis& d) {
  if (!std::isfinite(d.floor_m())) return {};
  return {{scale_of(d).per_m * d.floor_m(), "floor"}};
}

bool was_taken(const selection::Candidate& candidate, std::vector<std::string> taken) {
  std::vector<std::string> effects = candidate.effects;
  std::sort(effects.begin(), effects.end());
  std::sort(taken.begin(), taken.end());
  return effects == taken;
}

Plot candidates_plot(const selection::Diagnosis& d, std::size_t index) {
  const selection::Round& round = d.search.rounds[index];
  const LengthScale scale = scale_of(d);
  const std::vector<std::string> taken = taken_in(d.search, index);
  Plot plot{.title = "Round " + std::to_string(index + 1),
            .kind = PlotKind::bars,
            .y = {"held-out error", scale.unit},
            .lines = floor_line(d),
            .horizontal = true,
            .width = present::PlotWidth::half};
  plot.series = {{.name = "taken", .tone = Tone::improved},
                 {.name = "not taken", .tone = Tone::model},
                 {.name = "nothing added", .tone = Tone::muted}};
  const auto add = [&](const std::string& name, double rms_m, std::size_t which) {
    plot.categories.push_back(name);
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
      plot.series[s].y.push_back(s == which ? scale.per_m * rms_m : std::nan(""));
    }
  };
  for (const selection::Candidate& candidate : round.candidates) {
    const bool worse = candidate.validation_rms_m > kWorse * round.before.fitted.validation_rms_m;
    if (!candidate.fitted_at_all || worse || plot.categories.size() == kDrawnCandidates) break;
    add(config::schema::joined(candidate.effects, " + "), candidate.validation_rms_m,
        was_taken(candidate, taken) ? 0 : 1);
  }
  add("nothing added", round.before.fitted.validation_rms_m, 2);
  const auto unused = [](const present::Series& series) {
    return std::none_of(series.y.begin(), series.y.end(), [](double y) { return !std::isnan(y); });
  };
  plot.series.erase(std::remove_if(plot.series.begin(), plot.series.end(), unused),
                    plot.series.end());
  return plot;
}

/// "Rejected by the screening and not fitted: backlash, ..."
std::string not_fitted_words(const selection::Round& round) {
  std::vector<std::string> names;
  for (const selection::Candidate& candidate : round.candidates) {
    if (!candidate.fitted_at_all) names.push_back(config::schema::joined(candidate.effects, " + "));
  }
  return names.empty()
             ? ""
             : "Rejected by the screening and not fitted: " + config::schema::listed(names) + ".";
}

Table candidates_table(const selection::Diagnosis& d, std::size_t index) {
  const selection::Round& round = d.search.rounds[index];
  const LengthScale scale = scale_of(d);
  const std::vector<std::string> taken = taken_in(d.search, index);
  const std::string with = round.before.added.empty()
                               ? "the model as given"
                               : "with " + config::schema::listed(round.before.added);
  Table table{.caption = "Round " + std::to_string(index + 1) + ", " + with,
              .columns = {Column{"effect", "", false}, Column{"held-out error", scale.unit},
                          Column{"× floor", ""}, Column{"chance p", ""}, Column{"", "", false}}};
  for (const selection::Candidate& candidate : round.candidates) {
    std::vector<std::string> row{config::schema::joined(candidate.effects, " + ")};
    if (!candidate.fitted_at_all) continue;
    const bool took = was_taken(candidate, taken);
    row.push_back(scale.words(candidate.validation_rms_m));
    row.push_back(config::units::times_words(candidate.validation_rms_m / d.floor_m()));
    row.push_back(config::units::chance_words(candidate.p_value));
    row.emplace_back(!took ? "" : stayed(d.search, taken) ? "taken" : "taken, dropped later");
    if (took) table.marked_rows.push_back(table.rows.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string variable_words(const std::string& variable) {
  if (variable == "y") return "position y";
  if (variable == "v") return "velocity v";
  if (variable == "u") return "command u";
  return variable;
}

std::string change_words(double value, double before) {
  if (before == 0.0 || !std::isfinite(before) || !std::isfinite(value)) return "";
  return fmt::format("{:+.1f}", 100.0 * (value / before - 1.0));
}

}  // namespace

Section falling_error_section(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The falling error"};
  section.paragraphs = {
      d.by_innovations ? "Error: the drift-corrected RMS of measured less modelled position (" +
                             split_words(outcome) + ")."
                       : "Held-out error: the drift-corrected RMS of measured less modelled "
                         "position on data that "
                         "were not fitted (" +
                             split_words(outcome) + ").",
      present::kFreeRunMeaning, present::kDriftCorrectedMeaning, present::kNoiseFloorMeaning};
  const std::vector<StepWords> steps = step_words(d);
  const LengthScale scale = scale_of(d);
  Plot plot{.title = "Held-out error, step by step",
            .kind = PlotKind::line,
            .y = {"held-out error", scale.unit, true},
            .lines = floor_line(d)};
  plot.series.push_back({.name = "held-out error", .tone = Tone::model});
  Table table{.columns = {Column{"step", "", false}, Column{"held-out error", scale.unit},
                          Column{"× floor", ""}}};
  for (const StepWords& step : steps) {
    plot.categories.push_back(step.what);
    plot.series[0].y.push_back(scale.per_m * step.rms_m);
    table.rows.push_back(
        {step.what, scale.words(step.rms_m), config::units::times_words(step.rms_m / d.floor_m())});
  }
  for (const StepWords& floor : floor_steps(d)) {
    table.rows.push_back({floor.what, scale.words(floor.rms_m),
                          config::units::times_words(floor.rms_m / d.floor_m())});
  }
  section.plots.push_back(std::move(plot));
  section.tables.push_back(std::move(table));
  return section;
}

Section candidates_section(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The candidates"};
  section.paragraphs = {
      d.by_innovations
          ? std::string(
                "Each round fits the most promising effects and spectral lines, each with a noise "
                "model of its own, to the innovations. One is taken when the likelihood says so; p "
                "is that of the likelihood ratio. The bars end at the error of a simulation") +
                (d.disturbance ? ", which the rig's disturbance dominates." : ".")
          : "Each round fits every absent effect together with all that the model has already, and "
            "scores it on held-out data. An effect is taken when it lowers that error by " +
                fmt::format("{:g}", 100.0 * selection::kWorthwhile) +
                " % or more and the gain is more than chance: p is the probability of such a gain "
                "by chance "
                "alone. The bars end at the held-out error, the dashed line is the floor."};
  for (std::size_t i = 0; i < d.search.rounds.size(); ++i) {
    const std::string not_fitted = not_fitted_words(d.search.rounds[i]);
    Plot plot = candidates_plot(d, i);
    if (plot.categories.size() > 1) {
      plot.caption = not_fitted;
      section.plots.push_back(std::move(plot));
    } else if (!not_fitted.empty()) {
      section.paragraphs.push_back("Round " + std::to_string(i + 1) + ". " + not_fitted);
    }
    Table table = candidates_table(d, i);
    if (!table.rows.empty()) section.tables.push_back(std::move(table));
  }
  if (section.plots.size() == 1) section.plots.front().width = present::PlotWidth::full;
  return section;
}

Section parameters_section(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  Section section{.heading = "The better model's parameters"};
  section.paragraphs = {
      "Fitted to all samples. The error is one standard error; none is given for a value at its "
      "bound."};
  if (!outcome.prepared->output.empty())
    section.paragraphs.push_back("Written to " + outcome.prepared->output + ".");
  Table table{.columns = {Column{"parameter", "", false}, Column{"value"}, Column{"± std. error"},
                          Column{"unit", "", false}, Column{"in the file"}, Column{"change", "%"},
                          Column{"", "", false}}};
  plant_sim::ModelFile file = outcome.prepared->problem.model;
  for (const selection::ParameterValue& p : d.parameters) {
    const config::units::Quantity q = config::units::quantity(p.name, p.value, p.std_error);
    const double* before = file.value(p.name);
    const bool added = was_added(d, p);
    const bool known = before != nullptr && !added;
    const std::string in_file =
        known ? config::units::quantity(p.name, *before, std::nan(""), p.value).value : "";
    if (added) table.marked_rows.push_back(table.rows.size());
    table.rows.push_back(
        {p.name, q.value, q.error, config::units::typeset(" " + q.unit).substr(1), in_file,
         known ? change_words(p.value, *before) : "",
         std::string(added ? "new" : "") + (p.at_bound          ? " at its bound"
                                            : p.held_by_prior() ? " held by its prior"
                                                                : "")});
  }
  section.tables.push_back(std::move(table));
  return section;
}

Section where_section(const DiagnosisReport& outcome) {
  Section section{.heading = "Where the rest enters"};
  section.paragraphs = {
      "The remaining residual, explained by smooth functions of one variable each, as a flow, a "
      "force, a change of the gain or an error of the measurement; scored on held-out data. Where "
      "several places explain about as much, the record does not tell them apart."};
  Table table{.columns = {Column{"enters", "", false}, Column{"variable", "", false},
                          Column{"explains of the squared residual", "%"}}};
  for (const selection::Localisation& where : outcome.diagnosis.where) {
    std::vector<std::string> sites{where.site};
    sites.insert(sites.end(), where.or_sites.begin(), where.or_sites.end());
    table.rows.push_back({config::schema::listed(sites, "or"), variable_words(where.variable),
                          where.explained_ratio > 0.0
                              ? fmt::format("{:.1f}", 100.0 * where.explained_ratio)
                              : "none"});
  }
  if (!table.rows.empty()) table.marked_rows = {0};
  section.tables.push_back(std::move(table));
  return section;
}

namespace {

present::ReportState state_of(const DiagnosisReport& outcome) {
  if (outcome.interrupted) return present::ReportState::warn;
  switch (outcome.diagnosis.verdict) {
    case selection::Verdict::nothing_missing:
      return present::ReportState::good;
    case selection::Verdict::unexplained:
      return outcome.diagnosis.missing.empty() ? present::ReportState::bad
                                               : present::ReportState::warn;
    default:
      return present::ReportState::warn;
  }
}

present::Fact length_fact(const std::string& label, double length_m) {
  const config::units::Quantity q = config::units::quantity("length_m", length_m, std::nan(""));
  return {.label = label, .value = q.value, .unit = config::units::typeset(" " + q.unit).substr(1)};
}

std::string title_of(const DiagnosisReport& outcome) {
  const auto names = [](std::vector<std::string> files) {
    for (std::string& file : files) file = file_name(file);
    return config::schema::listed(files);
  };
  std::string title =
      file_name(outcome.prepared->model_file) + " against " + names(outcome.prepared->records);
  if (!outcome.prepared->holdouts.empty())
    title += ", held out " + names(outcome.prepared->holdouts);
  return title;
}

std::vector<present::Fact> facts_of(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  std::vector<present::Fact> facts;
  if (outcome.has_better_model()) {
    facts.push_back(length_fact("Held-out error, file", d.nominal_rms_m));
    facts.push_back(length_fact("Its parameters fitted", d.rms_before_m));
    if (d.adds_to_file()) {
      facts.push_back(length_fact(
          d.verdict == selection::Verdict::changing ? "With the change" : "Effects added",
          d.rms_after_m));
    }
  }
  if (d.repetitions_set_floor()) facts.push_back(length_fact("Between repetitions", d.floor_m()));
  if (std::isfinite(d.noise_floor_m)) facts.push_back(length_fact("Noise floor", d.noise_floor_m));
  if (outcome.has_better_model()) {
    facts.push_back(length_fact("Free run, model file", outcome.free_run_before_m));
    facts.push_back(length_fact("Free run, better model", outcome.free_run_after_m));
  }
  return facts;
}

}  // namespace

present::Report report_of(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  present::Report report;
  report.title = title_of(outcome);
  report.verdict = config::units::typeset(verdict_words(d));
  report.state = state_of(outcome);
  for (const std::string& remark : remarks(outcome))
    report.summary.push_back(config::units::typeset(remark));
  for (const std::string& note : notes(outcome))
    report.summary.push_back("Note: " + config::units::typeset(note) + ".");
  report.next_command = next_command(outcome);
  report.facts = facts_of(outcome);
  report.command = outcome.prepared->command;
  if (outcome.has_better_model()) {
    report.sections.push_back(falling_error_section(outcome));
    if (!d.search.rounds.empty()) report.sections.push_back(candidates_section(outcome));
    report.sections.push_back(parameters_section(outcome));
    if (!d.laws.empty()) report.sections.push_back(laws_section(outcome));
    if (auto steps = steps_section(outcome)) report.sections.push_back(std::move(*steps));
    if (!d.where.empty()) report.sections.push_back(where_section(outcome));
  }
  for (present::Section& section : record_sections(outcome)) {
    report.sections.push_back(std::move(section));
  }
  return report;
}

}  // namespace workbench::diagnose
