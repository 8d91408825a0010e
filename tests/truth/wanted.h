// The effects that record number `index` of a plan hides, and its conditions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/truth/conditions.h"
#include "tests/truth/left_out.h"
#include "tests/truth/record.h"

namespace truth {

/// Slow and fast motions by turns.
const std::vector<std::string>& mixed_motions();

struct Wanted {
  std::vector<std::string> effects;  ///< with the friction variants
  const LeftOutInfo* left_out = nullptr;
  std::vector<std::string> motions = mixed_motions();
  std::size_t first_motion = 0;
  double shows = 1.8;  ///< visibility (visibility.h) that is enough
  Kind kind = Kind::actuator;
  const Condition* condition = nullptr;
  bool disturbed = false;
  std::size_t which_outside = 0;
  bool mismatched = false;
  double off_most = 0.0;  ///< every value of the plant up to this; 0: as draw_plant() has it
};

/// Throws std::invalid_argument for an unknown plan.
Wanted wanted(const std::string& plan, std::size_t index, Random& random);

}  // namespace truth
