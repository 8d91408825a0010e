// Each kind of rig: its usual loop, sensor and motion, its printed plant, and how far
// a built one is off it.
#pragma once

#include <string>
#include <vector>

#include "tests/truth/record.h"

namespace truth {

struct PlantField {
  std::string name;
  double* (*at)(Case&);
  double reach;  ///< how far a fit may move it, relative; 0: something else stands for it
  double Plant::*member = nullptr;  ///< the actuator's
};
/// The parameters by which one rig differs from the next of its kind.
const std::vector<PlantField>& plant_fields(Kind kind);

std::string to_string(Kind kind);
/// The loop, sensor and motion that such a rig has, and its printed plant.
Case typical_case(Kind kind);
/// Gives the case a plant off the printed values, as drawn from its seed.
void draw_plant(Case& of);
/// The same with every value up to `most` off, relative.
void draw_plant_within(Case& of, double most);

}  // namespace truth
