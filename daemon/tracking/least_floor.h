// The least noise that a measured position is taken to have.
#pragma once

namespace monitor::tracking {

/// Better than any rod's sensor; simulated ones may show no noise at all.
inline constexpr double kLeastFloor_m = 1e-9;

}  // namespace monitor::tracking
