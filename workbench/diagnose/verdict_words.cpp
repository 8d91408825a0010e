#include "workbench/diagnose/verdict_words.h"

#include <algorithm>
#include <string>
#include <vector>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "plant_sim/formula/formula_effect.h"
#include "workbench/diagnose/change_words.h"
#include "workbench/diagnose/effect_words.h"
#include "workbench/diagnose/error_words.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/rival_words.h"

namespace workbench::diagnose {
namespace {

/// "2.7 um held-out, 1.1 times the noise floor of 2.4 um".
std::string beside_floor(const selection::Diagnosis& d, double rms_m) {
  const bool noise = !d.repetitions_set_floor() && !d.disturbance;
  return config::units::length_words(rms_m) + " on held-out data, " +
         config::units::times_words(rms_m / d.floor_m()) + " times " + floor_name(d) +
         (noise ? " of " : ", ") + config::units::length_words(d.floor_m());
}

/// The established effects that no rival disputes.
std::vector<std::string> undisputed(const selection::Diagnosis& d) {
  std::vector<std::string> names;
  for (const std::string& effect : d.established()) {
    const bool disputed =
        std::any_of(d.ambiguous.begin(), d.ambiguous.end(), [&](const auto& group) {
          return std::find(group.begin(), group.end(), effect) != group.end();
        });
    if (!disputed) names.push_back(effect);
  }
  return names;
}

/// The effect with its value, and the names that are as good.
std::string effect_or_rivals(const selection::Diagnosis& d, const std::string& effect) {
  std::string text = effect_words(d, effect);
  for (const std::vector<std::string>& group : d.same_here) {
    if (group.front() != effect) continue;
    const std::vector<std::string> others(group.begin() + 1, group.end());
    text += " (or " + config::schema::listed(others, "or") + " in its place)";
  }
  return text;
}

std::string missing_words(const selection::Diagnosis& d) {
  const auto text = [&](const std::string& effect) { return effect_or_rivals(d, effect); };
  return "Missing: " + config::schema::joined_by(d.established(), text, "; ") + ".";
}

std::vector<std::string> possible_names(const selection::Diagnosis& d) {
  std::vector<std::string> names;
  for (const selection::PossibleEffect& one : d.possible) names.push_back(one.effect);
  return names;
}

std::string undetermined_words(const selection::Diagnosis& d) {
  if (d.ambiguous.empty() && d.established().empty())
    return "Undetermined: perhaps missing: " + effects_words(d, d.missing) + ".";
  if (d.ambiguous.empty()) {
    const std::vector<std::string> doubted = possible_names(d);
    std::vector<std::string> sure = d.missing;
    std::erase_if(sure, [&](const std::string& name) {
      return std::find(doubted.begin(), doubted.end(), name) != doubted.end();
    });
    return "Undetermined: missing: " + effects_words(d, sure) +
           "; perhaps missing too: " + effects_words(d, doubted) + ".";
  }
  const std::vector<std::string> sure = undisputed(d);
  return "Undetermined: " + groups_words(d) + " is missing, and this motion cannot tell which." +
         (sure.empty() ? "" : " Missing in any case: " + effects_words(d, sure) + ".");
}

/// "cubic_damping, damping that grows with the cube of the speed: force = ...".
std::string law_words(const selection::Law& law) {
  const plant_sim::formula::FormulaSite* site =
      plant_sim::formula::find_formula_site(law.effect.site);
  return law.effect.what + ": " + (site == nullptr ? law.effect.site : site->result) + " = " +
         law.effect.equation();
}

/// The laws that come near to what is missing; empty: there are none.
std::string approximation_words(const selection::Diagnosis& d) {
  return d.laws.empty()
             ? ""
             : " The nearest law: " + config::schema::joined_by(d.laws, law_words, "; and ") + ".";
}

std::string unexplained_words(const selection::Diagnosis& d) {
  // what happens once may lie in samples that no held-out error sees
  const bool in_fitted = d.rms_after_m <= selection::kUnexplained * d.floor_m() &&
                         d.fitted_rms_m > selection::kFittedToo * d.floor_m();
  const std::string rest =
      in_fitted ? "an error of " + config::units::length_words(d.fitted_rms_m) +
                      " remains in the samples that are fitted, " +
                      config::units::times_words(d.fitted_rms_m / d.floor_m()) + " times the floor"
                : "an error of " + beside_floor(d, d.rms_after_m) + ", remains";
  if (d.checks && d.checks->misread()) {
    const auto gain = std::find_if(d.parameters.begin(), d.parameters.end(), [](const auto& one) {
      return one.name.find("gain") != std::string::npos;
    });
    return "Unexplained: " + rest +
           ". What is missing was not sought: read the record as it says below first" +
           (gain == d.parameters.end() || !d.checks->wrong_scale
                ? "."
                : ", or, where the file's gain is off, free it with --prior " + gain->name +
                      "=none.");
  }
  if (d.search.interrupted) {
    return "Not decided: " +
           (d.missing.empty() ? "" : "found so far " + names_words(d, d.missing) + "; ") + rest +
           ".";
  }
  const std::vector<std::string> established = d.established();
  if (established.empty()) {
    return "Unexplained: " + rest + ", and " +
           (d.effects_only ? "none of the effects that were to be tried"
                           : "no effect of the library") +
           " explains it." + approximation_words(d);
  }
  return "Incomplete: " + names_words(d, established) + (established.size() > 1 ? " are" : " is") +
         " missing, but " + rest + "." + approximation_words(d);
}

std::string learned_words(const selection::Diagnosis& d) {
  std::vector<std::string> laws;
  for (const selection::Law& law : d.laws) laws.push_back(law_words(law));
  const std::vector<std::string> beside = d.established();
  const std::string named =
      beside.empty()
          ? ""
          : names_words(d, beside) + (beside.size() > 1 ? " are" : " is") + " missing, and beside ";
  return "Learned: " + named +
         (beside.empty()      ? ""
          : beside.size() > 1 ? "them "
                              : "it ") +
         "no effect of the library explains the record, but " +
         config::schema::joined(laws, "; and ") + ".";
}

}  // namespace

std::string verdict_words(const selection::Diagnosis& d) {
  switch (d.verdict) {
    case selection::Verdict::nothing_missing:
      if (d.search.interrupted) {
        return "Not decided: the model, its own parameters adjusted, is left with " +
               beside_floor(d, d.rms_after_m) + " so far.";
      }
      return "Nothing is missing: the model, its own parameters adjusted, is left with " +
             beside_floor(d, d.rms_after_m) +
             (d.search.refused.empty() ? ", and no effect of the library lowers it further."
                                       : ", and no effect that lowers it further was taken.");
    case selection::Verdict::missing:
      return missing_words(d);
    case selection::Verdict::undetermined:
      return undetermined_words(d);
    case selection::Verdict::learned:
      return learned_words(d);
    case selection::Verdict::changing:
      return changing_words(d);
    case selection::Verdict::unexplained:
      return unexplained_words(d);
    case selection::Verdict::not_excited:
      break;
  }
  return "The record cannot tell: " + excitation_words(d.excitation) + ".";
}

}  // namespace workbench::diagnose
