// Limits of guards that a reload changes while the daemon runs. What a guard is and does (id, kind,
// channel, action) stays until a restart; its numbers may change.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/control/guard_config.h"

namespace monitor::control {

/// True for a key of [[guard]] that is a limit: "high_m", "time_s".
[[nodiscard]] bool is_guard_limit(std::string_view key) noexcept;

/// The first limit by which a guard lets more pass than before, "travel:
/// high_m"; empty: none. Guards are compared by id.
[[nodiscard]] std::string loosened_limit(const std::vector<GuardConfig>& before,
                                         const std::vector<GuardConfig>& after);

/// `before` with the limits of the guards of the same id in `after`; order,
/// kinds and actions stay.
[[nodiscard]] std::vector<GuardConfig> with_limits_of(std::vector<GuardConfig> before,
                                                      const std::vector<GuardConfig>& after);

}  // namespace monitor::control
