#include "workbench/diagnose/error_words.h"

#include "config/units/quantity.h"
#include "workbench/diagnose/effect_words.h"

namespace workbench::diagnose {

std::string floor_name(const selection::Diagnosis& d) {
  if (d.repetitions_set_floor()) return "the scatter between repetitions of the motion";
  return d.disturbance ? "the floor that sensor and disturbance set" : "the noise floor";
}

namespace {

/// The error that the predictor leaves which judged the models: that of simulations holds the
/// disturbance and hardly shows what is missing.
std::string prediction_words(const selection::Diagnosis& d) {
  if (d.missing.empty() || !d.changing.empty() || !d.prediction) return "";
  return " One sample ahead, predictions are off by " +
         config::units::length_words(d.prediction->before_m) + " without and by " +
         config::units::length_words(d.prediction->after_m) + " with " + names_words(d, d.missing) +
         ".";
}

}  // namespace

std::string fall_words(const selection::Diagnosis& d) {
  if (d.missing.empty() && d.verdict != selection::Verdict::changing) {
    return "With the plant's own parameters fitted, the held-out error goes from " +
           config::units::length_words(d.nominal_rms_m) + " to " +
           config::units::length_words(d.rms_before_m) + ".";
  }
  const std::string with = d.verdict == selection::Verdict::undetermined
                               ? "With " + names_words(d, d.missing) + ", the"
                               : "The";
  const std::string before = config::units::length_words(d.rms_before_m);
  const std::string after = config::units::length_words(d.rms_after_m);
  const bool falls = d.rms_after_m < d.rms_before_m;
  const std::string course = (falls ? "falls from " : "goes from ") + before + " to " + after;
  const bool held = d.prediction && !falls;
  return with + " held-out error " +
         (held ? "of a simulation, which holds the disturbance, " : "") +
         (before == after ? "stays at " + after : course) +
         (d.rms_after_m < d.floor_m() ? ", within " + floor_name(d) + ", "
                                      : "; " + floor_name(d) + " is ") +
         config::units::length_words(d.floor_m()) + "." + prediction_words(d);
}

}  // namespace workbench::diagnose
