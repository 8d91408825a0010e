// A record's description as text, so that any record can be made again:
//
//   motion=multisine,mismatched=1,friction.coulomb_N=150,friction.static_N=190
//   motion=fast_steps,left_out=cubic_damping,left_out.size=2.5e5,plant.mass_kg=52
//
//   motion=sine,plant=printed,at15:plant.supply_pressure_Pa=8.61e6,at30:plant.supply_pressure_Pa=...
//
// Keys: rig (actuator, linear_axis, rotary_axis, single_rod), motion, amplitude_ratio, period_s (of
// a motion that repeats), mismatched, length_s, sample_s, log_every, log_mean, kp_V_per_m,
// ki_V_per_m_s, kd_V_s_per_m, feed_V_s_per_m (record.h), noise_m, encoder_m, converter_V,
// pressure_noise_Pa (makes columns supply_pressure_Pa, pressure_in_Pa, pressure_out_Pa),
// outside.NAME (outside.h), EFFECT.PARAMETER (the product's names, SI), left_out, left_out.size,
// left_out.where, plant.NAME, plant=printed; on the actuator atSECONDS: before a plant's or an
// effect's key makes it a change at that time. What is not given is neutral, and on an axis the
// loop and the sensor are its own. The plant's own values are drawn from the seed:
//   actuator  gain +-3 %, damping and bulk modulus +-8 %, and when mismatched natural frequency
//             +-12 %, damping ratio +-12 %, mass +-8 %, dead volume +-20 %, supply pressure +-5 %
//   axis      damping +-15 %, mass +-10 %; the gain is exact, because command and position alone
//             cannot tell it from the scale of all forces
//   rod       valve gain, supply, damping, frequency and bulk modulus +-15 %, mass +-30 %
#pragma once

#include <string>
#include <vector>

#include "tests/truth/kinds.h"
#include "tests/truth/record.h"
#include "tests/truth/shown.h"

namespace truth {

/// Throws std::invalid_argument with the allowed words.
Case parse_case(const std::string& text, std::size_t seed);
/// Keys of a case beside rig, motion, plant, left_out, the plant's and the effects' own.
std::vector<std::string> case_keys();
/// The text from which parse_case makes the same case, whatever the seed's plant.
std::string to_text(const Case& of);

}  // namespace truth
