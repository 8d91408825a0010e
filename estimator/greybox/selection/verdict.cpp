// A diagnosis read as a whole: its verdict and doubts in words of the JSON, what is established,
// its floors.
#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::nothing_missing:
      return "nothing_missing";
    case Verdict::missing:
      return "missing";
    case Verdict::undetermined:
      return "undetermined";
    case Verdict::learned:
      return "learned";
    case Verdict::changing:
      return "changing";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::not_excited:
      break;
  }
  return "not_excited";
}

const char* to_string(Doubt doubt) {
  switch (doubt) {
    case Doubt::at_bound:
      return "at_bound";
    case Doubt::within_error:
      return "within_error";
    case Doubt::chance:
      return "chance";
    case Doubt::undriven:
      return "undriven";
    case Doubt::strained:
      return "strained";
    case Doubt::below_noise:
      return "below_noise";
    case Doubt::rivals:
      return "rivals";
    case Doubt::remainder:
      return "remainder";
    case Doubt::interrupted:
      return "interrupted";
    case Doubt::stand_in:
      break;
  }
  return "stand_in";
}

std::vector<std::string> Diagnosis::established() const {
  std::vector<std::string> names = missing;
  std::erase_if(names, [&](const std::string& name) {
    return std::any_of(possible.begin(), possible.end(),
                       [&](const PossibleEffect& one) { return one.effect == name; }) ||
           std::any_of(laws.begin(), laws.end(),
                       [&](const Law& law) { return law.effect.name == name; });
  });
  return names;
}

bool Diagnosis::rests_on_one_of(const std::vector<std::string>& names) const {
  if (verdict != Verdict::unexplained && verdict != Verdict::missing) return true;
  const std::vector<std::string> sure = established();
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::find(sure.begin(), sure.end(), name) != sure.end();
  });
}

double Diagnosis::disturbed_floor_m() const {
  return disturbance ? std::hypot(noise_floor_m, disturbance->rms_m) : noise_floor_m;
}

bool Diagnosis::repetitions_set_floor() const {
  return repetition && repetition->scatter_m > disturbed_floor_m() &&
         repetition->scatter_m < rms_after_m;
}

double Diagnosis::floor_m() const {
  return repetitions_set_floor() ? repetition->scatter_m : disturbed_floor_m();
}

}  // namespace estimator::greybox::selection
