// The axis of the model that a piece of work is about: its units are printed.
#pragma once

#include "config/units/quantity.h"
#include "plant_sim/model_file.h"

namespace workbench::present {

using config::units::PrintedAxis;

/// For PrintedAxis.
[[nodiscard]] config::units::Motion motion_of(const plant_sim::ModelFile& model);

}  // namespace workbench::present
