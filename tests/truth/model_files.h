// The model files that a plan's records are to be diagnosed with, at the printed values. Those of
// the actuator are judged with the product's own config/models/thesis.toml.
#pragma once

#include <string>

#include "tests/truth/record.h"

namespace truth {

/// linear_axis.toml, rotary_axis.toml, servo.toml; empty for the actuator.
std::string model_name(Kind kind);
/// Empty for the actuator.
std::string model_text(Kind kind);
/// Into a folder that exists; throws std::runtime_error. Does nothing for the actuator.
void write_model(Kind kind, const std::string& folder);

}  // namespace truth
