// One reading of everything that a rig measures, for `--check`: a wrong address, word order, scale
// or sign shows before anything moves.
#pragma once

#include <string>

#include "hal/rig.h"

namespace monitor {

/// "position 305.02 mm, e_stop 1, supply 140 bar"; "none" for what cannot be read. Writes nothing.
[[nodiscard]] std::string readings_now(const hal::Devices& devices);

}  // namespace monitor
