#include "workbench/diagnose/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/record/command_advance.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/held_scale.h"
#include "workbench/diagnose/change_words.h"
#include "workbench/diagnose/doubt_words.h"
#include "workbench/diagnose/effect_words.h"
#include "workbench/diagnose/error_words.h"
#include "workbench/diagnose/place_words.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/rival_words.h"
#include "workbench/present/disturbance_words.h"
#include "workbench/present/dynamics_plots.h"
#include "workbench/present/shell_command.h"

namespace workbench::diagnose {
namespace {

/// Distance of a value from the file's, in standard deviations of its prior, that strains this.
constexpr double kFar_sds = 2.5;

/// True for a log of some of a loop's samples: the command changes between them.
bool leaves_out_commands(const DiagnosisReport& outcome) {
  const std::vector<estimator::greybox::Dataset>& records = outcome.prepared->problem.data.records;
  return config::record::interpolates(outcome.diagnosis.command_lead_samples) ||
         std::any_of(records.begin(), records.end(),
                     [](const auto& record) { return record.command_is_interpolated; });
}

/// True where a delay of the model makes up for the advance that was asked for.
bool takes_advance_back(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const double advance_s = outcome.prepared->reading.advance_command_s;
  return advance_s > 0.0 &&
         std::find(d.missing.begin(), d.missing.end(), "transport_delay") != d.missing.end() &&
         d.final.value("transport_delay.delay_s") > 0.5 * advance_s;
}

/// Why a diagnosis ended before everything was tried.
std::string interruption_words(const DiagnosisReport& outcome) {
  const std::string rest =
      "this is the best so far. Not everything was tried, so other effects may do as well";
  if (!outcome.out_of_time) return "Interrupted: " + rest + ".";
  return fmt::format("Out of time after the {:g} s of --within: {}; a longer limit may decide.",
                     outcome.prepared->within_s, rest);
}

std::string refused_words(const selection::RefusedModel& model, const selection::Diagnosis& d) {
  const std::vector<std::string>& taken = d.missing;
  const bool part =
      std::all_of(model.effects.begin(), model.effects.end(), [&](const std::string& effect) {
        return std::find(taken.begin(), taken.end(), effect) != taken.end();
      });
  const auto name = [&](const std::string& effect) { return name_words(d, effect); };
  const std::string what =
      "Not taken: " + config::schema::joined_by(model.effects, name, " + ") +
      (part ? " alone" : "") +
      (d.by_innovations ? ", which fitted to simulations would leave " : ", which would leave ") +
      config::units::length_words(model.validation_rms_m);
  switch (model.why) {
    case selection::Refusal::unsupported:
      return what + ": one half of the record does not support it.";
    case selection::Refusal::dispensable:
      return what + ": one of these effects gains less than its parameters cost.";
    case selection::Refusal::unlikely:
      break;
  }
  return what + (d.disturbance ? ": a disturbance explains the samples better."
                               : ": the better model predicts each next sample better.");
}

}  // namespace

std::string file_name(const std::string& file) { return file.substr(file.find_last_of('/') + 1); }

bool was_added(const selection::Diagnosis& diagnosis, const selection::ParameterValue& parameter) {
  const std::vector<std::string>& names = diagnosis.missing;
  const std::string effect = parameter.name.substr(0, parameter.name.find('.'));
  return !parameter.in_model && std::find(names.begin(), names.end(), effect) != names.end();
}

/// Parameters that the record has moved far from what the file says of them.
void add_strained_words(const selection::Diagnosis& d, std::vector<std::string>& out) {
  std::vector<std::string> at_bound;
  std::vector<const selection::ParameterValue*> far;
  for (const selection::ParameterValue& p : d.parameters) {
    const bool own = p.name.find('.') == std::string::npos;
    if (own && p.at_bound && p.value != 0.0) at_bound.push_back(p.name);
    if (std::abs(p.prior_sds) >= kFar_sds && !was_added(d, p)) far.push_back(&p);
  }
  const auto side = [](const selection::ParameterValue* p) {
    return p->prior_sds > 0.0 ? "above" : "below";
  };
  if (far.size() == 1) {
    out.push_back(fmt::format(
        "{} ends {:.1f} standard deviations of its prior {} the file's value: the file is wrong "
        "about it, or something that acts as it does is missing.",
        far.front()->name, std::abs(far.front()->prior_sds), side(far.front())));
  } else if (!far.empty()) {
    const auto text = [&](const selection::ParameterValue* p) {
      return fmt::format("{} {:.1f} {}", p->name, std::abs(p->prior_sds), side(p));
    };
    out.push_back("These lie far from the file's values, in standard deviations of their priors: " +
                  config::schema::joined_by(far, text, ", ") +
                  ". The file is wrong about them, or something that acts as they do is missing.");
  }
  if (at_bound.empty()) return;
  const bool one = at_bound.size() == 1;
  out.push_back(config::schema::listed(at_bound) +
                (one ? " ends at its bound" : " end at their bounds") +
                ": the errors of the others do not contain by how much " +
                (one ? "it may be off." : "they may be off."));
}

/// Data-sheet values that the record corrects by much, though their wide priors allow it.
void add_corrected_words(const DiagnosisReport& outcome, std::vector<std::string>& out) {
  constexpr double kMuch_ratio = 1.5;
  constexpr double kSure = 0.1;
  constexpr double kDataSheet_sd = 0.5;
  const selection::Diagnosis& d = outcome.diagnosis;
  // where physics is missing, values make up for it
  if (d.verdict == selection::Verdict::unexplained) return;
  for (const estimator::greybox::FreeParameter& p : outcome.prepared->problem.plant_parameters) {
    const auto found =
        std::find_if(d.parameters.begin(), d.parameters.end(),
                     [&](const selection::ParameterValue& one) { return one.name == p.name; });
    const bool of_file = p.scale == estimator::greybox::ParameterScale::logarithmic;
    if (found == d.parameters.end() || found->at_bound || !of_file) continue;
    if (!(p.prior_sd <= kDataSheet_sd)) continue;
    if (!(std::abs(found->prior_sds) < kFar_sds)) continue;  // that has been said
    if (!(std::abs(std::log(found->value / p.unit)) > std::log(kMuch_ratio)) ||
        !(found->std_error < kSure * found->value)) {
      continue;
    }
    out.push_back(fmt::format(
        "{} is {}, where the file says {}.", p.name,
        config::units::words(config::units::quantity(p.name, found->value, found->std_error)),
        config::units::words(config::units::quantity(p.name, p.unit, std::nan("")))));
  }
}

std::string held_words(const DiagnosisReport& outcome) {
  std::vector<std::string> names;
  for (const selection::ParameterValue& p : outcome.diagnosis.parameters) names.push_back(p.name);
  return greybox::held_scale_words(outcome.prepared->problem.model, names);
}

std::vector<std::string> remarks(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  std::vector<std::string> out;
  if (outcome.interrupted) {
    out.push_back(interruption_words(outcome));
  }
  for (std::string& text : record_remarks(outcome)) out.push_back(std::move(text));
  if (outcome.misread()) return out;  // the rest is about a record read wrongly
  if (d.verdict != selection::Verdict::not_excited) out.push_back(fall_words(d));
  if (d.loses_motion) {
    out.emplace_back(
        "The rig amplifies the smallest differences until a simulation loses the motion, whatever "
        "its numbers: effects and errors rest on the predictions from sample to sample.");
  }
  const bool named = d.verdict == selection::Verdict::missing || d.missing.empty();
  if (!named) out.push_back("Used in the better model: " + effects_words(d, d.missing) + ".");
  if (d.verdict != selection::Verdict::changing) {
    for (const selection::ParameterChange& change : d.changing) {
      out.push_back(change_words(change) +
                    ": something changed on the rig, or in its readings, then.");
    }
  }
  if (takes_advance_back(outcome)) {
    out.push_back(fmt::format("The delay takes back --advance {:.6g}: diagnose without it first.",
                              outcome.prepared->reading.advance_command_s));
  }
  add_strained_words(d, out);
  add_corrected_words(outcome, out);
  if (d.repetition) {
    out.push_back("The motion repeats every " +
                  config::units::words(
                      config::units::quantity("period_s", d.repetition->period_s, std::nan(""))) +
                  ": of what remains, " + config::units::length_words(d.repetition->scatter_m) +
                  " differs from one repetition to the next, which no model of the command can "
                  "explain, and " +
                  config::units::length_words(d.repetition->repeating_m) + " repeats.");
  }
  if (d.disturbance) {
    out.push_back("What remains does not follow from command or motion: " +
                  present::disturbance_words(*d.disturbance) + "." +
                  (leaves_out_commands(outcome)
                       ? " The commands between the samples, which this log leaves out, look "
                         "the same: it need not be a disturbance of the rig."
                       : ""));
  }
  if (outcome.resonance) out.push_back(present::resonance_words(*outcome.resonance));
  if (!d.possible.empty()) {
    for (std::string& text : doubt_words(d)) out.push_back(std::move(text));
  }
  for (const selection::RefusedModel& model : d.search.refused) {
    out.push_back(refused_words(model, d));
  }
  for (std::string& text : rival_words(d)) out.push_back(std::move(text));
  const std::string held = held_words(outcome);
  if (!held.empty()) out.push_back(held);
  if (!d.where.empty()) out.push_back(place_words(d));
  if (std::isfinite(outcome.free_run_before_m)) {
    out.push_back("The free run from the first sample is off by " +
                  config::units::length_words(outcome.free_run_before_m) +
                  " RMS with the model file as it is, by " +
                  config::units::length_words(outcome.free_run_after_m) + " with the better model" +
                  (std::isfinite(outcome.free_run_heldout_m)
                       ? "; on what was not fitted, by " +
                             config::units::length_words(outcome.free_run_heldout_m)
                       : "") +
                  ".");
  }
  if (!outcome.advice.empty()) out.push_back(outcome.advice);
  return out;
}

namespace {

/// The command with --set step_s=`step_s`, in the place of another step where it has one.
std::string with_step(std::string command, const std::string& step_s) {
  const std::string set = "--set step_s=";
  const std::size_t at = command.find(set);
  if (at == std::string::npos) return command + " " + set + step_s;
  const std::size_t value = at + set.size();
  return command.replace(value, command.find(' ', value) - value, step_s);
}

/// `command` with --flip, or without where it has it.
std::string with_other_sign(std::string command) {
  const std::string flip = " --flip";
  const std::size_t at = command.find(flip);
  return at == std::string::npos ? command + flip : command.erase(at, flip.size());
}

/// The command with --advance of as much more.
std::string with_advance(const PreparedDiagnosis& input, double more_s) {
  const std::string advance = " --advance ";
  const std::string sum_s = fmt::format("{:.6g}", input.reading.advance_command_s + more_s);
  std::string command = input.command;
  const std::size_t at = command.find(advance);
  if (at == std::string::npos) return command + advance + sum_s;
  const std::size_t value = at + advance.size();
  return command.replace(value, command.find(' ', value) - value, sum_s);
}

/// Options with which `compare` reads a record as the better model was fitted to it.
std::vector<std::string> reading_options(const DiagnosisReport& outcome) {
  const PreparedDiagnosis& input = *outcome.prepared;
  std::vector<std::string> options;
  if (!input.reading.map.empty()) options.insert(options.end(), {"--map", input.reading.map});
  if (!input.reading.resample.empty()) options.push_back("--resample=" + input.reading.resample);
  if (input.reading.flip_command) options.emplace_back("--flip");
  const double advance_s = advanced_s(outcome);
  if (advance_s != 0.0)
    options.insert(options.end(), {"--advance", fmt::format("{:.6g}", advance_s)});
  for (const std::string& span : input.ignored) options.insert(options.end(), {"--ignore", span});
  return options;
}

}  // namespace

double advanced_s(const DiagnosisReport& outcome) {
  const PreparedDiagnosis& input = *outcome.prepared;
  return input.reading.advance_command_s +
         outcome.diagnosis.command_lead_samples * input.problem.data.sample_time_s;
}

std::string next_command(const DiagnosisReport& outcome) {
  if (!outcome.fitted()) return "";
  const selection::Diagnosis& d = outcome.diagnosis;
  const PreparedDiagnosis& input = *outcome.prepared;
  const std::string output = input.output.empty() ? " -o better.toml" : "";
  if (d.checks && d.checks->turned_sign()) return with_other_sign(input.command) + output;
  if (d.checks && d.checks->command_late_s > 0.0)
    return with_advance(input, d.checks->command_late_s) + output;
  if (outcome.misread()) return "";  // the user must decide the mapping
  if (input.output.empty()) {
    return (d.has_coarse_step() ? with_step(input.command, finer_step_words(d)) : input.command) +
           output;
  }
  std::vector<std::string> words{
      "spoolwatch", "compare", input.output,
      input.holdouts.empty() ? input.records.front() : input.holdouts.front()};
  for (std::string& option : reading_options(outcome)) words.push_back(std::move(option));
  return present::shell_command(words);
}

std::string split_words(const DiagnosisReport& outcome) {
  if (outcome.diagnosis.by_innovations) {
    return "effects judged by the likelihood of all innovations, errors those of simulations";
  }
  if (!outcome.prepared->holdouts.empty()) {
    return "fitted to " + config::schema::listed(outcome.prepared->records) + ", scored on " +
           config::schema::listed(outcome.prepared->holdouts);
  }
  const greybox::Split split = outcome.prepared->split;
  if (split.block_s > 0.0) {
    return fmt::format("fitted to every other {:g} s, scored on the rest, each block begun anew",
                       split.block_s);
  }
  switch (split.kind) {
    case greybox::Split::first_half:
      return "fitted to the first half, scored on the second";
    case greybox::Split::second_half:
      return "fitted to the second half, scored on the first";
    case greybox::Split::blocks:
      break;
  }
  const std::vector<greybox::Dataset>& records = outcome.prepared->problem.data.records;
  const double length_s = records.empty() ? greybox::kBlock_s : greybox::block_s(records.front());
  return fmt::format("fitted to every other {:.2g} s, scored on the rest", length_s);
}

std::vector<StepWords> step_words(const selection::Diagnosis& diagnosis) {
  std::vector<StepWords> steps;
  if (diagnosis.steps.empty()) return steps;
  steps.push_back({"model file as it is", diagnosis.nominal_rms_m});
  for (const selection::SelectionStep& step : diagnosis.steps) {
    steps.push_back({step.added.empty() ? "its parameters fitted" : "+ " + step_name(step.added),
                     step.validation_rms_m});
  }
  // Refinements of what was added may come and go in the end.
  constexpr double kSame = 1e-3;
  if (std::abs(steps.back().rms_m - diagnosis.rms_after_m) > kSame * diagnosis.rms_after_m) {
    steps.push_back({"refined", diagnosis.rms_after_m});
  }
  return steps;
}

std::vector<StepWords> floor_steps(const selection::Diagnosis& d) {
  std::vector<StepWords> floors;
  if (d.repetitions_set_floor()) floors.push_back({"between repetitions", d.floor_m()});
  if (d.disturbance) floors.push_back({"sensor and disturbance", d.disturbed_floor_m()});
  floors.push_back({"noise floor", d.noise_floor_m});
  return floors;
}

}  // namespace workbench::diagnose
