// The scale that a fit holds (estimator/greybox/held_scale.h) as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "estimator/greybox/held_scale.h"

namespace workbench::present {

/// null where there is none.
[[nodiscard]] nlohmann::ordered_json json_of(const estimator::greybox::HeldScale& held);

}  // namespace workbench::present
