// The model that a command works on, and with it the units in which all is printed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plant_sim/model_file.h"

namespace workbench::present {

/// plant_sim::load_model(), then the motion of its axis is the one that is printed
/// (config::units::set_motion).
[[nodiscard]] plant_sim::ModelFile load_printed_model(
    const std::filesystem::path& file, const std::vector<std::string>& assignments = {});
/// Prints as the model's axis moves.
void print_as(const plant_sim::ModelFile& model);

}  // namespace workbench::present
