// A record's description as text, so that any record can be made again:
//
//   motion=multisine,mismatched=1,friction.coulomb_N=150,friction.static_N=190
//   motion=fast_steps,left_out=cubic_damping,left_out.size=2.5e5,plant.mass_kg=52
//
//   motion=sine,plant=printed,at15:plant.supply_pressure_Pa=8.61e6,at30:plant.supply_pressure_Pa=...
//
// Keys: motion, mismatched, length_s, kp_V_per_m, noise_m, encoder_m, pressure_noise_Pa (makes
// columns supply_pressure_Pa, pressure_in_Pa, pressure_out_Pa), outside.NAME (outside.h),
// EFFECT.PARAMETER (the product's names, SI), left_out, left_out.size, left_out.where, plant.NAME,
// plant=printed; atSECONDS: before a plant's or an effect's key makes it a change at that time.
// What is not given is neutral; the plant's own values are drawn from the seed: gain +-3 %, damping
// and bulk modulus
// +-8 %, and when mismatched natural frequency +-12 %, damping ratio +-12 %, mass +-8 %, dead
// volume +-20 %, supply pressure +-5 %.
#pragma once

#include <string>
#include <vector>

#include "tests/truth/rig.h"

namespace truth {

/// One parameter of one effect: where it is kept, and how near a fit has to come.
struct Parameter {
  std::string effect;
  std::string name;
  double Hidden::*member;
  double tolerance;  ///< relative; 0: not scored (the record does not determine it by itself)
};

const std::vector<Parameter>& parameters();
/// The library's effects, each once.
const std::vector<std::string>& effects();
/// The effects of the case that are not neutral.
std::vector<std::string> hidden_effects(const Hidden& hidden);
/// The same with one effect taken out.
Hidden without(Hidden hidden, const std::string& effect);

struct PlantField {
  std::string name;
  double Plant::*member;
};
const std::vector<PlantField>& plant_fields();

/// A plant off the printed values, as drawn from the seed.
Plant draw_plant(std::size_t seed, bool mismatched);
/// Throws std::invalid_argument with the allowed words.
Case parse_case(const std::string& text, std::size_t seed);
/// The text from which parse_case makes the same case, whatever the seed's plant.
std::string to_text(const Case& of);

}  // namespace truth
