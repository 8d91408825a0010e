// The kinds of sources that know physics, for PipelineConfig: [[tracker]] (tracker_config.h).
#pragma once

#include <span>

#include "estimator/fdi/source.h"

namespace monitor::tracking {

[[nodiscard]] std::span<const estimator::fdi::SourceKind> source_kinds() noexcept;

}  // namespace monitor::tracking
