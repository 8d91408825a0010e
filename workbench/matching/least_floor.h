// The least noise that a measured position is taken to have.
#pragma once

#include "tracking/least_floor.h"

namespace workbench::matching {

using tracking::kLeastFloor_m;

}  // namespace workbench::matching
