#include "workbench/serve/job_summary.h"

#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/effect_words.h"
#include "workbench/diagnose/learned_curves.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"
#include "workbench/present/json.h"
#include "workbench/present/text.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;
using present::typeset;
using present::typeset_all;
namespace selection = estimator::greybox::selection;

std::string length(double value_m) { return typeset(config::units::length_words(value_m)); }

/// The candidates of all rounds with the error that each would reach.
ordered_json candidates_of(const selection::Diagnosis& diagnosis) {
  ordered_json out = ordered_json::array();
  const auto& rounds = diagnosis.search.rounds;
  for (std::size_t r = 0; r < rounds.size(); ++r) {
    for (const selection::Candidate& one : rounds[r].candidates) {
      if (!one.fitted_at_all || !std::isfinite(one.validation_rms_m)) continue;
      // To reach that error, what the rounds before have taken is needed too.
      std::vector<std::string> with = rounds[r].before.added;
      with.insert(with.end(), one.effects.begin(), one.effects.end());
      out.push_back({{"round", r + 1},
                     {"only", with},
                     {"effect", config::schema::joined(one.effects, "+")},
                     {"heldout_m", number_or_null(one.validation_rms_m)},
                     {"heldout", length(one.validation_rms_m)},
                     {"chance", typeset(config::units::chance_words(one.p_value))}});
    }
  }
  return out;
}

ordered_json numbers(const std::vector<double>& values, double per) {
  ordered_json out = ordered_json::array();
  for (const double value : values) out.push_back(number_or_null(value * per));
  return out;
}

/// A learned law as a curve with a band of two standard errors, in the units of its axes.
ordered_json curve_of(const diagnose::LearnedLaw& learned) {
  const estimator::greybox::LawCurve& curve = learned.curve;
  const diagnose::LawAxes axes = diagnose::axes_of(curve);
  const auto label = [](const std::string& name, const std::string& unit) {
    return name + ", " + typeset(config::units::axis_unit(unit));
  };
  std::vector<double> low;
  std::vector<double> high;
  for (std::size_t i = 0; i < curve.f.size(); ++i) {
    low.push_back(curve.f[i] - 2.0 * curve.std_error[i]);
    high.push_back(curve.f[i] + 2.0 * curve.std_error[i]);
  }
  return {{"x", label(axes.x_name, axes.x_unit)},
          {"y", label(axes.y_name, axes.y_unit)},
          {"note", typeset(axes.held)},
          {"model", {{"x", numbers(curve.x, axes.x_per)}, {"y", numbers(curve.f, 1.0)}}},
          {"low", numbers(low, 1.0)},
          {"high", numbers(high, 1.0)}};
}

ordered_json laws_of(const diagnose::DiagnosisReport& report) {
  ordered_json out = ordered_json::array();
  for (const diagnose::LearnedLaw& learned : diagnose::learned_laws(report)) {
    const selection::Law& law = *learned.law;
    out.push_back({{"name", law.effect.name},
                   {"what", law.effect.what},
                   {"formula", law.effect.formula},
                   {"values", typeset(diagnose::effect_words(report.diagnosis, law.effect.name))},
                   {"curve", curve_of(learned)}});
  }
  return out;
}

}  // namespace

ordered_json summary_of(const diagnose::DiagnosisReport& report) {
  const selection::Diagnosis& d = report.diagnosis;
  ordered_json out{{"kind", "diagnosis"}, {"words", typeset(diagnose::verdict_words(d))}};
  out["verdict"] = selection::to_string(d.verdict);
  out["remarks"] = typeset_all(diagnose::remarks(report));
  out["steps"] = ordered_json::array();
  if (report.has_better_model()) {
    for (const diagnose::StepWords& step : diagnose::step_words(d)) {
      out["steps"].push_back({{"what", step.what},
                              {"heldout_m", number_or_null(step.rms_m)},
                              {"heldout", length(step.rms_m)}});
    }
  }
  out["noise_floor_m"] = number_or_null(d.noise_floor_m);
  out["floors"] = ordered_json::array();
  for (const diagnose::StepWords& floor : diagnose::floor_steps(d)) {
    out["floors"].push_back({{"what", floor.what}, {"size", length(floor.rms_m)}});
  }
  out["candidates"] = candidates_of(d);
  out["laws"] = laws_of(report);
  out["interrupted"] = report.interrupted;
  return out;
}

ordered_json summary_of(const fit::FitReport& report) {
  ordered_json out{{"kind", "fit"}, {"words", ""}, {"remarks", ordered_json::array()}};
  const std::vector<std::string> words = fit::words(report);
  if (!words.empty()) {
    out["words"] = typeset(words.front());
    out["remarks"] = typeset_all({words.begin() + 1, words.end()});
  }
  out["interrupted"] = report.estimation.interrupted;
  return out;
}

}  // namespace workbench::serve
