#include "workbench/diagnose/report_pages.h"

#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/words.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
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
  if (outcome.fitted()) {
    facts.push_back(length_fact("Held-out error, file", d.nominal_rms_m));
    facts.push_back(length_fact("Its parameters fitted", d.rms_before_m));
    if (!d.missing.empty()) facts.push_back(length_fact("Effects added", d.rms_after_m));
  }
  if (std::isfinite(d.noise_floor_m)) facts.push_back(length_fact("Noise floor", d.noise_floor_m));
  if (outcome.fitted()) {
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
  if (outcome.fitted()) {
    report.sections.push_back(falling_error_section(outcome));
    if (!d.search.rounds.empty()) report.sections.push_back(candidates_section(outcome));
    report.sections.push_back(parameters_section(outcome));
    if (!d.where.empty()) report.sections.push_back(where_section(outcome));
  }
  for (present::Section& section : record_sections(outcome)) {
    report.sections.push_back(std::move(section));
  }
  return report;
}

}  // namespace workbench::diagnose
