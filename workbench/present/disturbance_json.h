// Disturbance of a rig, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "estimator/greybox/selection/disturbance_report.h"

namespace workbench::present {

/// rms_m, share, as, value, corner_Hz and lines; null for none.
[[nodiscard]] nlohmann::ordered_json disturbance_json(
    const std::optional<estimator::greybox::selection::Disturbance>& found);

}  // namespace workbench::present
