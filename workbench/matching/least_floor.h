// The least noise that a measured position is taken to have.
#pragma once

#include "daemon/tracking/least_floor.h"

namespace workbench::matching {

using monitor::tracking::kLeastFloor_m;

}  // namespace workbench::matching
