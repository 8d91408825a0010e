// Disturbance of a rig, in sentences.
#pragma once

#include <string>

#include "estimator/greybox/selection/disturbance_report.h"

namespace workbench::present {

/// "a random force of 30 N RMS, most of it below 3 Hz; a pulsation of the supply pressure of 1 bar
/// at 23.00 Hz".
[[nodiscard]] std::string disturbance_words(
    const estimator::greybox::selection::Disturbance& disturbance);

}  // namespace workbench::present
