// Detection methods that use a physical model, for PipelineConfig: [[tracker]] (tracker_config.h).
#pragma once

#include <span>

#include "estimator/fdi/detection_method_config.h"

namespace estimator::fdi::tracker {

[[nodiscard]] std::span<const estimator::fdi::DetectionMethodKind>
detection_method_kinds() noexcept;

}  // namespace estimator::fdi::tracker
