#include "workbench/diagnose/diagnosis_report.h"

#include <nlohmann/json.hpp>

#include "config/schema/joined.h"
#include "estimator/greybox/held_scale.h"
#include "workbench/diagnose/learned_curves.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"
#include "workbench/present/disturbance_json.h"
#include "workbench/present/held_scale_json.h"
#include "workbench/present/json.h"
#include "workbench/present/resonance_json.h"

namespace workbench::diagnose {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;

ordered_json candidates_of(const selection::StructureSearch& search) {
  ordered_json list = ordered_json::array();
  for (std::size_t r = 0; r < search.rounds.size(); ++r) {
    for (const selection::Candidate& c : search.rounds[r].candidates) {
      ordered_json one;
      one["round"] = r + 1;
      one["effect"] = config::schema::joined(c.effects, "+");
      one["rms_heldout_m"] =
          c.fitted_at_all ? number_or_null(c.validation_rms_m) : ordered_json(nullptr);
      one["p_value"] = c.fitted_at_all ? number_or_null(c.p_value) : ordered_json(nullptr);
      one["expected_ratio"] = number_or_null(c.expected_ratio);
      list.push_back(std::move(one));
    }
  }
  return list;
}

ordered_json parameters_of(const selection::Diagnosis& d) {
  ordered_json all = ordered_json::object();
  for (const selection::ParameterValue& p : d.parameters) {
    all[p.name] = {{"value", number_or_null(p.value)},
                   {"std_error", number_or_null(p.std_error)},
                   {"record_share", number_or_null(p.record_share)},
                   {"prior_sds", number_or_null(p.prior_sds)},
                   {"at_bound", p.at_bound}};
  }
  return all;
}

/// Effects that the file has, of which something is missing.
ordered_json refined_of(const selection::Diagnosis& d) {
  ordered_json list = ordered_json::array();
  for (const std::string& effect : d.missing) {
    if (d.is_in_file(effect)) list.push_back(effect);
  }
  return list;
}

ordered_json held_scale_of(const DiagnosisReport& outcome) {
  std::vector<std::string> names;
  for (const selection::ParameterValue& p : outcome.diagnosis.parameters) names.push_back(p.name);
  return present::json_of(greybox::held_scale(outcome.prepared->problem.model, names));
}

ordered_json refused_of(const selection::StructureSearch& search) {
  ordered_json list = ordered_json::array();
  for (const selection::RefusedModel& model : search.refused) {
    list.push_back({{"effects", model.effects},
                    {"rms_heldout_m", number_or_null(model.validation_rms_m)},
                    {"why", selection::to_string(model.why)}});
  }
  return list;
}

ordered_json changing_of(const selection::Diagnosis& d) {
  ordered_json changes = ordered_json::array();
  for (const selection::ParameterChange& change : d.changing) {
    changes.push_back(
        {{"parameter", change.parameter},
         {"kind", selection::to_string(change.kind)},
         {"record", change.record.empty() ? ordered_json() : ordered_json(change.record)},
         {"at_s", number_or_null(change.at_s)},
         {"duration_s", number_or_null(change.duration_s)},
         {"from", number_or_null(change.from)},
         {"to", number_or_null(change.to)},
         {"std_error",
          {{"at_s", number_or_null(change.at_error_s)},
           {"from", number_or_null(change.from_error)},
           {"to", number_or_null(change.to_error)}}},
         {"rivals", change.rivals}});
  }
  return changes;
}

/// Null where simulations alone were judged.
ordered_json prediction_of(const selection::Diagnosis& d) {
  if (!d.prediction) return nullptr;
  return {{"rms_before_m", number_or_null(d.prediction->before_m)},
          {"rms_after_m", number_or_null(d.prediction->after_m)}};
}

ordered_json numbers_of(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

ordered_json curve_of(const greybox::LawCurve& curve) {
  ordered_json json;
  json["variable"] = curve.variable;
  json["quantity"] = curve.quantity;
  json["held"] = curve.held ? ordered_json({{curve.held->variable, curve.held->value}})
                            : ordered_json::object();
  json["x"] = numbers_of(curve.x);
  json["f"] = numbers_of(curve.f);
  json["std_error"] = numbers_of(curve.std_error);
  json["share"] = numbers_of(curve.share);
  return json;
}

/// The points of a curve, whose values are the parameters; null for a formula.
ordered_json table_of(const plant_sim::formula::FormulaEffect& effect) {
  if (!effect.curve) return nullptr;
  return {{"over", effect.curve->over}, {"times", effect.curve->times}, {"x", effect.curve->x}};
}

ordered_json laws_of(const DiagnosisReport& outcome) {
  ordered_json laws = ordered_json::array();
  for (const LearnedLaw& learned : learned_laws(outcome)) {
    const plant_sim::formula::FormulaEffect& effect = learned.law->effect;
    ordered_json parameters = ordered_json::object();
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      const auto& declared = effect.parameters[i];
      parameters[declared.name] = {{"value", number_or_null(learned.parameters[i].value)},
                                   {"std_error", number_or_null(learned.parameters[i].std_error)},
                                   {"what", declared.what},
                                   {"min", declared.min},
                                   {"max", declared.max},
                                   {"typical", declared.typical},
                                   {"neutral", declared.neutral}};
    }
    laws.push_back({{"name", effect.name},
                    {"what", effect.what},
                    {"site", effect.site},
                    {"variables", learned.law->variables},
                    {"formula", effect.equation()},
                    {"table", table_of(effect)},
                    {"parameters", parameters},
                    {"rms_heldout_m", number_or_null(outcome.diagnosis.rms_after_m)},
                    {"curve", curve_of(learned.curve)}});
  }
  return laws;
}

}  // namespace

std::string to_json(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const bool fitted = outcome.fitted();
  const auto error_m = [&](double value) {
    return fitted ? number_or_null(value) : ordered_json(nullptr);
  };
  ordered_json json;
  json["verdict"] = selection::to_string(d.verdict);
  json["missing"] = d.established();
  json["refined"] = refined_of(d);
  json["may_be"] = ordered_json::array();
  for (const selection::PossibleEffect& one : d.possible) {
    json["may_be"].push_back({{"effect", one.effect}, {"why", selection::to_string(one.why)}});
  }
  json["ambiguous"] = d.ambiguous;
  json["same_here"] = d.same_here;
  json["noise_floor_m"] = number_or_null(d.noise_floor_m);
  json["nominal_rms_m"] = error_m(d.nominal_rms_m);
  json["rms_before_m"] = error_m(d.rms_before_m);
  json["rms_after_m"] = error_m(d.rms_after_m);
  json["free_run_before_m"] = number_or_null(outcome.free_run_before_m);
  json["free_run_after_m"] = number_or_null(outcome.free_run_after_m);
  json["free_run_heldout_m"] = number_or_null(outcome.free_run_heldout_m);
  json["parameters"] = parameters_of(d);
  json["held_scale"] = held_scale_of(outcome);
  json["candidates"] = candidates_of(d.search);
  json["where"] = ordered_json::array();
  for (const selection::Localisation& where : d.where) {
    json["where"].push_back({{"class", where.site},
                             {"variable", where.variable},
                             {"explained_ratio", number_or_null(where.explained_ratio)},
                             {"or_class", where.or_sites}});
  }
  json["record"] = {{"turned_sign", d.checks && d.checks->turned_sign()},
                    {"position_turned", d.checks && d.checks->position_turned},
                    {"records_differ", d.checks && d.checks->records_differ},
                    {"wrong_scale", d.checks && d.checks->wrong_scale},
                    {"columns_exchanged", d.checks && d.checks->columns_exchanged},
                    {"command_late_s", d.checks ? d.checks->command_late_s : 0.0},
                    {"outside_stroke", d.checks && d.checks->outside_stroke()},
                    {"command_lead_samples", d.command_lead_samples}};
  json["plants"] = ordered_json::array();
  for (const selection::PlantFit& fit : d.plants) {
    ordered_json values = ordered_json::object();
    for (const plant_sim::NamedValue& one : fit.values) values[one.name] = one.value;
    json["plants"].push_back({{"plant", fit.plant},
                              {"rms_heldout_m", number_or_null(fit.validation_rms_m)},
                              {"parameters", std::move(values)}});
  }
  json["changing"] = changing_of(d);
  json["laws"] = laws_of(outcome);
  json["resonance"] = present::resonance_json(outcome.resonance);
  json["prediction"] = prediction_of(d);
  json["disturbance"] = present::disturbance_json(d.disturbance);
  json["floor"] = {
      {"sensor_m", number_or_null(d.noise_floor_m)},
      {"repeat_m", number_or_null(d.repetition ? d.repetition->scatter_m : std::nan(""))},
      {"disturbed_m", number_or_null(d.disturbed_floor_m())},
      {"step_m", number_or_null(d.step_error_m)}};
  json["steps"] = ordered_json::array();
  for (const selection::SelectionStep& step : d.steps) {
    ordered_json one;
    one["added"] = step.added.empty() ? ordered_json(nullptr) : ordered_json(step.added);
    one["rms_heldout_m"] = number_or_null(step.validation_rms_m);
    json["steps"].push_back(std::move(one));
  }
  json["dropped"] = refused_of(d.search);
  json["advice"] = outcome.advice;
  json["words"] = verdict_words(d);
  json["notes"] = notes(outcome);
  json["interrupted"] = outcome.interrupted;
  json["model"] = outcome.prepared->model_file;
  json["records"] = outcome.prepared->records;
  json["holdouts"] = outcome.prepared->holdouts;
  json["command"] = outcome.prepared->command;
  json["preview_s"] = number_or_null(d.search.preview_s);
  json["runtime_s"] = number_or_null(d.runtime_s);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace workbench::diagnose
