#include "workbench/diagnose/record_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/representative_segments.h"
#include "workbench/present/dataset_notes.h"
#include "workbench/present/record_findings.h"

namespace workbench::diagnose {
namespace {

std::string command_lead_words(double lead_samples) {
  if (lead_samples >= 1.0) {
    return fmt::format(
        "Command and position are {:.3g} samples apart: the record is taken with the command that "
        "much earlier. Look at how the two are logged.",
        lead_samples);
  }
  return fmt::format(
      "The command goes on to change between two samples of this record, which keeps some of a "
      "faster loop's: it is taken {:.2g} samples earlier. A log of every sample of the loop says "
      "more.",
      lead_samples);
}

/// True where a model explains how the position follows the command: what the response alone looks
/// like is then the plant's doing, a dead time apart, for which clocks may be to blame.
bool is_explained(const selection::Diagnosis& d, const greybox::CommandResponse& response) {
  const bool explained = d.verdict == selection::Verdict::nothing_missing ||
                         d.verdict == selection::Verdict::missing ||
                         d.verdict == selection::Verdict::learned ||
                         d.verdict == selection::Verdict::changing;
  return explained && response.delay_s >= 0.0 &&
         std::find(d.missing.begin(), d.missing.end(), "transport_delay") == d.missing.end();
}

void add_checks(const DiagnosisReport& outcome, std::vector<std::string>& out) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const selection::RecordChecks& checks = *d.checks;
  const std::vector<greybox::Dataset>& records = outcome.prepared->problem.data.records;
  if (checks.turned_sign()) {
    out.push_back(
        fmt::format("The sign of command or position is turned: with -u {} times less of the "
                    "motion remains. Diagnose "
                    "again with{} --flip.",
                    config::units::times_words(checks.turned_sign_ratio),
                    outcome.prepared->reading.flip_command ? "out" : ""));
  }
  if (checks.position_turned) {
    out.push_back(present::turned_position_finding(records.front().position_column) + ".");
    return;
  }
  if (checks.exchanged_ratio > 1.0) {
    const std::string map =
        present::exchanging_map(records.front().command_column, records.front().position_column);
    out.push_back(fmt::format(
        "Command and position look exchanged: the other way round {} times less of the motion "
        "remains{}.",
        config::units::times_words(checks.exchanged_ratio),
        map.empty() ? "" : "; read them with " + map));
  }
  if (checks.command_late_s > 0.0) {
    out.push_back(fmt::format(
        "The command is logged {:.4g} ms after it acts: the clocks of command and position are "
        "shifted. Diagnose again with --advance {:.6g}.",
        1e3 * checks.command_late_s,
        outcome.prepared->reading.advance_command_s + checks.command_late_s));
  }
  std::set<std::string> said;  // of a record's blocks, the first that shows something
  for (std::size_t i = 0; i < std::min(records.size(), checks.responses.size()); ++i) {
    if (checks.turned_sign() || checks.exchanged_ratio > 1.0 || checks.command_late_s > 0.0) break;
    if (checks.responses[i].columns_exchanged() && !checks.columns_exchanged) continue;
    if (said.contains(records[i].name) || is_explained(d, checks.responses[i])) continue;
    for (const std::string& text : present::response_findings(
             checks.responses[i], records[i].command_column, records[i].position_column)) {
      out.push_back(records[i].name + ": " + text + ".");
      said.insert(records[i].name);
    }
  }
  if (checks.records_differ) {
    out.emplace_back(
        "The records are not read alike: mend each by itself with import and --flip, --advance or "
        "--map, and diagnose what it writes.");
    return;
  }
  // a span tells nothing where the positions as they are follow the command
  const greybox::ValueRange range = checks.stroke_m > 0.0 || checks.wrong_scale
                                        ? greybox::ValueRange{checks.low_m, checks.high_m}
                                        : greybox::ValueRange{0.0, 0.0};
  const std::string size =
      records.empty()
          ? std::string()
          : present::size_finding(range, checks.stroke_m, checks.motion,
                                  records.front().command_column, records.front().position_column);
  if (!size.empty()) out.push_back(records.front().name + ": " + size + ".");
  if (checks.outside_stroke() && size.empty()) {
    std::vector<std::string> ends;
    if (checks.below_m < 0.0) {
      ends.push_back("by " + config::units::length_words(-checks.below_m) +
                     " before its beginning");
    }
    if (checks.beyond_m > 0.0) {
      ends.push_back("by " + config::units::length_words(checks.beyond_m) + " beyond its end");
    }
    out.push_back("The position leaves the model's stroke " +
                  config::schema::joined(ends, " and ") + ": look at its unit and its zero.");
  }
  if (d.fits_another_plant()) {
    const selection::PlantFit& other = d.plants.front();
    const auto rod = std::find_if(other.values.begin(), other.values.end(),
                                  [](const auto& one) { return one.name == "rod_side_area_m2"; });
    const std::string with = rod == other.values.end()
                                 ? ", without any effect,"
                                 : fmt::format(" with rod_side_area_m2 = {:.4g}", rod->value);
    out.push_back("Another plant follows this record better: " + other.plant + with + " leaves " +
                  config::units::length_words(other.validation_rms_m) + ".");
  }
}

}  // namespace

std::string excitation_words(const selection::Excitation& excitation) {
  using Cause = selection::Excitation::Cause;
  const auto millimetres = [](double m) {
    return fmt::format("{:.3g} {}", 1e3 * m, config::units::axis_unit("mm"));
  };
  switch (excitation.cause) {
    case Cause::sufficient:
      break;
    case Cause::no_motion:
      return "the " + config::units::moving_part() + " moves by " +
             millimetres(excitation.travel_m) + " in all, " +
             millimetres(excitation.noise_floor_m) + " of it noise";
    case Cause::command_at_limit:
      return "the command stays at its limit throughout";
  }
  return "the records hardly move";
}

std::string finer_step_words(const selection::Diagnosis& d) {
  constexpr double kLeast_s = 1e-6;  // a model file's
  return fmt::format("{:.2g}", std::max(kLeast_s, 0.25 * d.better.step_s));
}

std::vector<std::string> notes(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  std::vector<std::string> out = present::notes_of(data.records);
  if (!d.excitation.sufficient()) out.push_back(excitation_words(d.excitation));
  if (d.searched_s) {
    out.push_back("effects were searched for in " + std::to_string(std::lround(*d.searched_s)) +
                  " of " + std::to_string(std::lround(greybox::length_s(data))) + " s" +
                  (d.by_innovations ? "" : "; values and errors are those of all samples"));
  }
  if (d.floor_assumed && d.excitation.sufficient()) {
    out.emplace_back(std::string("noise cannot be told from motion at this rate: the floor is ") +
                     (d.by_innovations ? "estimated with the model" : "the rounding alone"));
  }
  const double given_step_s = outcome.prepared->problem.model.step_s;
  if (d.better.step_s < given_step_s) {
    out.push_back(fmt::format(
        "simulated with steps of {:.2g} s: those of {:.2g} s that the model gives are too coarse",
        d.better.step_s, given_step_s));
  }
  if (d.has_coarse_step()) {
    out.push_back(
        fmt::format("a quarter of the integration step changes the simulation by {}, {} times {}: "
                    "values may be "
                    "off by more than their errors; run again with --set step_s={}",
                    config::units::length_words(d.step_error_m),
                    config::units::three_digits(d.step_error_m / d.floor_m()),
                    d.floor_m() > d.noise_floor_m ? "what no model can explain" : "the noise floor",
                    finer_step_words(d)));
  }
  if (d.search.interrupted) out.emplace_back("interrupted: the best so far");
  return out;
}

std::vector<std::string> record_remarks(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  std::vector<std::string> out;
  if (d.command_lead_samples > 0.0) out.push_back(command_lead_words(d.command_lead_samples));
  if (d.checks) add_checks(outcome, out);
  return out;
}

}  // namespace workbench::diagnose
