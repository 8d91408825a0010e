// The parameter that records of command and position cannot determine because every force of the
// plant scales with it: it is held at the file's value, and what is fitted scales with it.
//
//   M v' = g u - d v - F    the same motion with c g, c M, c d and c F, for any c
//
// On force_driven_axis g is the gain. On the cylinders, with Ai Pi - Ao Po in place of g u, every
// area, flow and volume scales with the forces at the same pressures, and a fall of pressure per
// flow inversely.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/model_file.h"

namespace estimator::greybox {

struct HeldScale {
  std::string parameter;               ///< empty: none
  std::vector<std::string> also_held;  ///< held in its ratio to the parameter: the other area
  std::vector<std::string> scaled;     ///< fitted parameters that are proportional to it
  std::vector<std::string> inverse;    ///< fitted parameters that are inversely proportional
};

/// True for a mass, a force, or a force per speed or way: "kg", "N", "N s/m".
[[nodiscard]] bool is_force(const std::string& name);

[[nodiscard]] HeldScale held_scale(const plant_sim::ModelFile& model,
                                   const std::vector<std::string>& fitted);
/// The same as a sentence; empty where there is none.
[[nodiscard]] std::string held_scale_words(const plant_sim::ModelFile& model,
                                           const std::vector<std::string>& fitted);

}  // namespace estimator::greybox
