// How much of a hidden effect a record shows to a model that lacks it: the ratio of the error that
// remains to the noise floor.
//
// The plant with and without the effect follows the recorded command; their difference, with slow
// drift taken out (s/(s + 2), what output injection does), is what a model without the effect gets
// wrong. From it goes what a change of the plant's own parameters can imitate: linear least
// squares, each within its reach (plant_fields(): on the actuator gain and valve dynamics and mass
// within 20 %, bulk modulus and dead volume within 40 %, damping within 60 %).
// ratio = sqrt(1 + (rest/floor)^2).
#pragma once

#include "tests/truth/record.h"

namespace truth {

/// `lacking` is the plant that made the record, without the effect in question.
double visibility_ratio(const Case& lacking, const Record& record);

}  // namespace truth
