// Conditions under which an actuator's records are made, other than 30 s at 200 Hz with a
// proportional controller and a sensor of 5 um.
#pragma once

#include <string>
#include <vector>

#include "tests/truth/record.h"

namespace truth {

struct Condition {
  std::string name;
  std::vector<std::string> motions;  ///< empty: any rich one
  void (*apply)(Case&);
};

const std::vector<Condition>& conditions();
/// A motion that repeats every 5 s.
const Condition& repeating();

}  // namespace truth
